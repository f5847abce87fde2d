// SPDX-License-Identifier: Apache-2.0
// Ghosts for tests: outlines from slim to round, with fades from sharp to wide.
#pragma once

#include <random>
#include <string>

#include "contrejour/expert/measured_flare.h"

namespace contrejour::test {

inline GhostOutline random_outline(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  GhostOutline o;
  o.centre = -0.5 + unit(random);
  o.left = 0.02 + 0.2 * unit(random);
  o.right = 0.02 + 0.2 * unit(random);
  o.half_height = 0.02 + 0.2 * unit(random);
  o.round_left = 0.3 + 0.5 * unit(random);
  o.round_right = 0.3 + 0.5 * unit(random);
  return o;
}

// An outline that a circle cuts, from either side.
inline GhostOutline random_cut_outline(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  GhostOutline o = random_outline(random);
  o.clip_radius = 0.05 + 0.3 * unit(random);
  o.clip_centre = o.centre + (unit(random) < 0.5 ? -1.0 : 1.0) * o.clip_radius * (0.4 + 0.6 * unit(random));
  return o;
}

inline GhostShade random_shade(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  return {0.001 + 0.05 * unit(random), 0.0005 + 0.02 * unit(random), 0.5 + 3.0 * unit(random),
          0.5 + 3.0 * unit(random)};
}

// A ghost that grows and moves with the light.
inline MeasuredGhost random_ghost(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const GhostOutline o = random_outline(random);
  const GhostShade shade = random_shade(random);
  MeasuredGhost ghost;
  ghost.name = std::to_string(random() % 1000U);
  ghost.centre.coefficients = {2.0 * o.centre, 0.3 * unit(random)};
  ghost.half_width.coefficients = {0.5 * (o.left + o.right), 0.05 * unit(random)};
  ghost.skew.coefficients = {0.02 * unit(random)};
  ghost.half_height.coefficients = {o.half_height, 0.05 * unit(random)};
  ghost.width_in.coefficients = {shade.fade_in / (shade.slope_in + 1.0)};
  ghost.width_out.coefficients = {shade.fade_out / (shade.slope_out + 1.0)};
  ghost.slope_in.coefficients = {shade.slope_in};
  ghost.slope_out.coefficients = {shade.slope_out};
  for (std::size_t c = 0; c < 3; ++c) {
    ghost.border[c].coefficients = {0.5 + unit(random)};
    ghost.inside[c].coefficients = {0.5 * unit(random)};
  }
  ghost.last = 0.6;
  return ghost;
}

// The same, cut by a circle that moves into it as the light leaves the axis.
inline MeasuredGhost random_cut_ghost(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  MeasuredGhost ghost = random_ghost(random);
  const double radius = ghost.half_width(0.0);
  ghost.clip_centre.coefficients = {ghost.centre.coefficients[0] + (2.0 + unit(random)) * radius, 0.1 * unit(random)};
  ghost.clip_radius.coefficients = {(1.0 + 0.2 * unit(random)) * radius, 0.02 * unit(random)};
  return ghost;
}

// An uncut ghost with a profile inside, which changes with the angle and is nowhere below 0.
inline MeasuredGhost random_ghost_with_profile(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  MeasuredGhost ghost = random_ghost(random);
  for (std::vector<AngleCurve>& terms : ghost.profile) {
    for (std::size_t k = 0; k < kProfileTerms; ++k) {
      const bool plain = profile_term(k).harmonic == 0;
      const Parity parity = profile_term(k).harmonic == 1 ? Parity::Odd : Parity::Even;
      const double size = plain ? 0.8 + unit(random) : 0.3 * unit(random);
      terms.push_back({parity, {size, 0.5 * unit(random)}});
    }
  }
  return ghost;
}

}  // namespace contrejour::test
