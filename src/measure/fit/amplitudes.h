// SPDX-License-Identifier: Apache-2.0
// A flare's pictures are linear in its levels: those of borders and insides, and of the profiles inside its ghosts. For
// outlines that are given, the levels of all ghosts and stations follow from one system of linear equations.
// Thread-safety: pure functions; the same bits for any number of threads.
#pragma once

#include <span>

#include "contrejour/context.h"
#include "measure/fit/flare_problem.h"

namespace contrejour::inline internal {

struct AmplitudeSettings {
  // Coefficients of each curve of a profile. A ghost of which a picture shows fewer than `least_radius_px` has none.
  std::size_t profile_coefficients = 2;
  std::size_t most_directed_coefficients = 3;  // of curves of terms with a direction, which have as many or fewer
  double least_radius_px = 4.0;
  double smoothness = 0.01;  // how much neighbouring rings are held to one another, over what a ring's pixels weigh
  double huber = 3.0;
  int rounds = 2;  // of robust weights
};

// The flare with the levels that fit best, none below 0. Outlines and shades stay.
[[nodiscard]] MeasuredFlare with_best_amplitudes(std::span<const FitStation> stations, MeasuredFlare flare,
                                                 const AmplitudeSettings& settings, const Context& context);

}  // namespace contrejour::inline internal
