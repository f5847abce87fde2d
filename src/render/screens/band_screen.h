// What stands in the stop behind a polygon, channel by channel, in place of a sharp iris.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "contrejour/vec.h"
#include "render/screens/band_pattern.h"
#include "render/screens/iris_screens.h"

namespace contrejour::screens {

// What a disc of the stop sees of a screen: part, and about how much light passes at the most; 1 where it is more.
struct ScreenView {
  ScreenPart part;
  double most;
};

// The screens of some wavelengths that are drawn together, and each one's part of each channel's light.
struct BandScreen {
  struct Part {
    std::shared_ptr<const StopScreen> screen;
    std::array<float, 3> channel{};
  };
  std::vector<Part> parts;
  [[nodiscard]] bool is_grey() const;  // one part, all of every channel

  [[nodiscard]] std::array<double, 3> share(std::span<const StopPlace> places) const;
  // Dark or level where all parts are.
  [[nodiscard]] ScreenView over(Vec2 middle, double radius) const;

  double unit = 0.1;  // of stop radii: no ripple is much finer
  // Of edges' fringes: beyond these distances outside and inside a bound there are none worth drawing.
  const EdgeScreen* edges = nullptr;  // the first part, if all are such
  double dark_beyond = 0.0, level_within = 0.0;
  std::shared_ptr<const BandPattern> pattern;  // of all parts, if they are such
  PatternHull hull;  // of a pattern, as far as it is worth drawing
  [[nodiscard]] double brightest(Vec2 middle, double radius) const;
  double unseen = 0.0;  // pixel values that do not count
};

}  // namespace contrejour::screens
