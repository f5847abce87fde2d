// SPDX-License-Identifier: Apache-2.0
// A fit of a lens's ghosts as a source of rays: those who draw ghosts evaluate it in place of tracing.
// Thread-safety: safe.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "polynomial/field_polynomials.h"
#include "render/pupils/ray_source.h"

namespace contrejour::inline internal::polynomial {

class FittedLens final : public pupils::FittedGhosts {
 public:
  explicit FittedLens(std::shared_ptr<const LensPolynomials> fit);

  // Null for lights at a finite distance or outside of the fit's field, wavelengths outside of its range, a stop that
  // is wider than the lens's, and zones that are Traced.
  [[nodiscard]] std::unique_ptr<pupils::FittedGhost> find(const pupils::RayRequest& request) const override;

  [[nodiscard]] const LensPolynomials& fit() const { return *fit_; }
  [[nodiscard]] std::size_t bytes() const { return bytes_; }

 private:
  [[nodiscard]] std::unique_ptr<pupils::FittedGhost> find_asymmetric(const pupils::RayRequest& request,
                                                                     const GhostPolynomials& ghost) const;

  struct OfGhost {
    const GhostPolynomials* ghost = nullptr;
    std::vector<PreparedZone> zones;  // those of the ghost
  };

  std::shared_ptr<const LensPolynomials> fit_;
  std::map<Ghost, OfGhost> ghosts_;
  std::size_t bytes_ = 0;
};

}  // namespace contrejour::inline internal::polynomial
