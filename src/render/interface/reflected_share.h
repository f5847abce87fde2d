// About which share of a wavelength's light the surfaces of a ghost reflect: what wavelengths weigh beside each other
// before any ray is traced.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "contrejour/ghost.h"
#include "contrejour/lens.h"

namespace contrejour {

class ReflectedShares {
 public:
  ReflectedShares() = default;
  ReflectedShares(const LensState& lens, std::span<const double> lambda_nm) { add(lens, lambda_nm); }

  // Those of the same lens at more wavelengths.
  void add(const LensState& lens, std::span<const double> lambda_nm);
  [[nodiscard]] std::size_t size() const { return by_wavelength_.size(); }

  // The product of its surfaces' mean reflectances up to 32 degrees from normal incidence. lambda_nm: one of those
  // given.
  [[nodiscard]] double of(const Ghost& ghost, double lambda_nm) const;

 private:
  std::map<double, std::vector<double>> by_wavelength_;  // one a surface; 1 of the stop
};

}  // namespace contrejour
