// SPDX-License-Identifier: Apache-2.0
// Fits so coarse that they take no time, for tests of what is done with a fit, not of its accuracy.
#pragma once

#include <algorithm>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/polynomial.h"

namespace contrejour::test {

// ghosts: empty: all on one side of the stop.
inline LensPolynomials coarse_polynomials(const LensState& lens, int max_order, std::vector<Ghost> ghosts = {}) {
  auto fitted = fit_polynomials(lens, {.position_px = 1e5,
                                       .edge = 1e3,
                                       .transmittance = 1e3,
                                       .target_px = 1.0,
                                       .max_order = max_order,
                                       .max_halvings = 0,
                                       .scope = GhostScope::OneSideOfStop,
                                       .ghosts = std::move(ghosts)});
  REQUIRE(fitted.has_value());
  return std::move(*fitted);
}

inline LensPolynomials coarse_triplet_polynomials(int max_order, std::vector<Ghost> ghosts = {}) {
  const auto lens = configure_lens(*find_lens("cooke-triplet"));
  REQUIRE(lens.has_value());
  return coarse_polynomials(*lens, max_order, std::move(ghosts));
}

inline bool is_fitted(const GhostPolynomials& ghost) {
  const auto fitted = [](const auto& zones) {
    return std::ranges::any_of(zones, [](const auto& zone) { return zone.state == PolynomialZone::State::Fitted; });
  };
  return fitted(ghost.zones) || fitted(ghost.asymmetric);
}

// The first ghosts of which a part is fitted.
inline std::vector<Ghost> fitted_ghosts(const LensPolynomials& fit, std::size_t count) {
  std::vector<Ghost> ghosts;
  for (const GhostPolynomials& ghost : fit.ghosts)
    if (ghosts.size() < count && is_fitted(ghost)) ghosts.push_back(ghost.ghost);
  REQUIRE(!ghosts.empty());
  return ghosts;
}

inline const GhostPolynomials& polynomials_of(const LensPolynomials& fit, const Ghost& ghost) {
  return *std::ranges::find(fit.ghosts, ghost, &GhostPolynomials::ghost);
}

}  // namespace contrejour::test
