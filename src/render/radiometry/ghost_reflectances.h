// SPDX-License-Identifier: Apache-2.0
// An approximate reflectance of a ghost's two reflections at a wavelength: it weights wavelengths against each other
// before any ray is traced.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "contrejour/expert/ghost.h"
#include "contrejour/lens.h"

namespace contrejour::inline internal {

class GhostReflectances {
 public:
  GhostReflectances() = default;
  GhostReflectances(const LensState& lens, std::span<const double> lambda_nm) { add(lens, lambda_nm); }

  // Adds more wavelengths of the same lens.
  void add(const LensState& lens, std::span<const double> lambda_nm);
  [[nodiscard]] std::size_t size() const { return by_wavelength_.size(); }

  // The product of the mean reflectances of its surfaces, up to 32 degrees from normal incidence. lambda_nm: one that
  // was given before.
  [[nodiscard]] double of(const Ghost& ghost, double lambda_nm) const;

 private:
  std::map<double, std::vector<double>> by_wavelength_;  // one for each surface; 1 for the stop
};

}  // namespace contrejour::inline internal
