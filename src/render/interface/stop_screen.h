// What the stop plane lets through of one ghost at one wavelength, where that is more than "inside the iris or not":
// ringing along the opening's edge. A ghost without a screen has the sharp iris.
// How a renderer uses one: it traces the ghost along widened(path, reach()) with a round iris, so that every search and
// every box holds the light beside the opening, and multiplies its irradiance by share() of the places where the light
// crosses the stop. Rims go on blocking. Thread-safety: const members may run at once.
#pragma once

#include <span>

#include "contrejour/trace.h"

namespace contrejour {

// A place where light crosses the stop, and the side of the square about it that is asked about (a pixel's, seen
// there): stop radii.
struct StopPlace {
  Vec2 at;
  double width = 0.0;
};

// What a screen is over a disc of the stop plane.
enum class ScreenPart { Dark, Level, Varied };  // all 0; all 1, as far as was asked; neither

class StopScreen {
 public:
  StopScreen() = default;
  StopScreen(const StopScreen&) = delete;
  StopScreen& operator=(const StopScreen&) = delete;
  virtual ~StopScreen() = default;

  // Light passes nowhere farther from the axis than this, in stop radii; 1 or more.
  [[nodiscard]] virtual double reach() const = 0;

  // The mean share of light that passes over a place's square: 0 and more, above 1 on bright fringes. One place for
  // each crossing of the stop along the path, in turn.
  [[nodiscard]] virtual double share(std::span<const StopPlace> places) const = 0;

  // At the last crossing, over the disc about a place; tolerance: how far from 1 is still level.
  [[nodiscard]] virtual ScreenPart over(Vec2 middle, double radius, double tolerance) const = 0;
};

// The same path with a stop so many times as large: TracedRay::stop is then in units of the larger radius.
[[nodiscard]] inline OpticalPath widened(OpticalPath path, double times) {
  path.stop_radius_mm *= times;
  return path;
}

}  // namespace contrejour
