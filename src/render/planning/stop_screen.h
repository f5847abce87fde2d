// SPDX-License-Identifier: Apache-2.0
// The diffraction pattern that takes the place of a sharp iris for one ghost at one wavelength: the transmittance of
// the stop plane with ringing along the opening's edge. A ghost without a pattern has the sharp iris. A renderer traces
// the ghost along widened(path, reach()) with a round iris, so that every search and every box includes the light
// outside the opening, and multiplies the irradiance by share() at the places where the light crosses the stop. Rims
// still block.
// Thread-safety: const members may run at once.
#pragma once

#include <span>

#include "contrejour/expert/trace.h"

namespace contrejour::inline internal {

// A place where light crosses the stop, and the side of the square about it over which the mean is taken (the image of
// a pixel in the stop plane), in stop radii.
struct StopPlace {
  Vec2 at;
  double width = 0.0;
};

// What a pattern is all over a disc of the stop plane.
enum class ScreenPart { Dark, Level, Varied };  // all 0; 1 within the tolerance; neither

class StopScreen {
 public:
  StopScreen() = default;
  StopScreen(const StopScreen&) = delete;
  StopScreen& operator=(const StopScreen&) = delete;
  virtual ~StopScreen() = default;

  // No light passes farther from the axis than this, in stop radii; at least 1.
  [[nodiscard]] virtual double reach() const = 0;

  // The mean transmittance over a place's square: at least 0, and above 1 on bright fringes. places: one for each
  // crossing of the stop, in the order of the path.
  [[nodiscard]] virtual double share(std::span<const StopPlace> places) const = 0;

  // What the pattern is over a disc at the last crossing; tolerance: the deviation from 1 that still counts as level.
  [[nodiscard]] virtual ScreenPart over(Vec2 middle, double radius, double tolerance) const = 0;
};

// The same path with a stop `times` as large; TracedRay::stop is then in units of the larger radius.
[[nodiscard]] inline OpticalPath widened(OpticalPath path, double times) {
  path.stop_radius_mm *= times;
  return path;
}

}  // namespace contrejour::inline internal
