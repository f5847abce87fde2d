// SPDX-License-Identifier: Apache-2.0
// All curves of a ghost in one order, with the names that files give them.
// Thread-safety: pure functions.
#pragma once

#include <array>
#include <string_view>

#include "contrejour/expert/measured_flare.h"

namespace contrejour::inline internal {

inline constexpr std::size_t kGhostCurves = 18;

inline constexpr std::array<std::string_view, kGhostCurves> kCurveNames{
    "centre",     "half_width",   "skew",        "half_height", "roundness",    "roundness_skew",
    "width_in",   "width_out",    "slope_in",    "slope_out",   "clip_centre",  "clip_radius",
    "border_red", "border_green", "border_blue", "inside_red",  "inside_green", "inside_blue"};

[[nodiscard]] inline std::array<const AngleCurve*, kGhostCurves> curves_of(const MeasuredGhost& g) {
  return {&g.centre,    &g.half_width, &g.skew,      &g.half_height, &g.roundness,   &g.roundness_skew,
          &g.width_in,  &g.width_out,  &g.slope_in,  &g.slope_out,   &g.clip_centre, &g.clip_radius,
          &g.border[0], &g.border[1],  &g.border[2], &g.inside[0],   &g.inside[1],   &g.inside[2]};
}
[[nodiscard]] inline std::array<AngleCurve*, kGhostCurves> curves_of(MeasuredGhost& g) {
  return {&g.centre,    &g.half_width, &g.skew,      &g.half_height, &g.roundness,   &g.roundness_skew,
          &g.width_in,  &g.width_out,  &g.slope_in,  &g.slope_out,   &g.clip_centre, &g.clip_radius,
          &g.border[0], &g.border[1],  &g.border[2], &g.inside[0],   &g.inside[1],   &g.inside[2]};
}

// The curves of the circle that cuts an outline: the only ones that a ghost may lack altogether.
inline constexpr std::size_t kClipCentre = 10, kClipRadius = 11;
[[nodiscard]] constexpr bool is_clip_curve(std::size_t k) { return k == kClipCentre || k == kClipRadius; }

// The parity of a profile's term, as the lens's symmetry demands.
[[nodiscard]] constexpr Parity profile_parity(std::size_t term) {
  return profile_term(term).harmonic % 2 == 1 ? Parity::Odd : Parity::Even;
}

// The power of s that the k-th coefficient of a curve multiplies.
[[nodiscard]] constexpr int power_of(Parity parity, std::size_t k) {
  const int n = static_cast<int>(k);
  return parity == Parity::None ? n : parity == Parity::Even ? 2 * n : 2 * n + 1;
}

}  // namespace contrejour::inline internal
