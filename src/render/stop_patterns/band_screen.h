// SPDX-License-Identifier: Apache-2.0
// The stop pattern in front of a polygon, channel by channel, in place of a sharp iris.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "contrejour/expert/vec.h"
#include "render/stop_patterns/band_pattern.h"
#include "render/stop_patterns/iris_screens.h"

namespace contrejour::inline internal::screens {

// The part of a stop pattern that a disc covers: its kind, and about its largest transmittance, at most 1.
struct ScreenView {
  ScreenPart part;
  double most;
};

// The stop patterns of wavelengths that are drawn together, with each one's fraction of each channel's light.
struct BandScreen {
  struct Part {
    std::shared_ptr<const StopScreen> screen;
    std::array<float, 3> channel{};
  };
  std::vector<Part> parts;
  [[nodiscard]] bool is_grey() const;  // a single part with all light of every channel

  [[nodiscard]] std::array<double, 3> share(std::span<const StopPlace> places) const;
  // Dark or uniform where all parts are.
  [[nodiscard]] ScreenView over(Vec2 middle, double radius) const;

  double unit = 0.1;  // in stop radii: no fringe is much finer
  // The next three describe edges' fringes, which are negligible beyond these distances outside and inside a bound.
  const EdgeScreen* edges = nullptr;  // the first part, if all parts have edges' fringes
  double dark_beyond = 0.0, level_within = 0.0;
  std::shared_ptr<const BandPattern> pattern;  // of all parts, if all are patterns
  PatternHull hull;  // bounding polygon of a pattern's visible light
  [[nodiscard]] double brightest(Vec2 middle, double radius) const;
  double unseen = 0.0;  // pixel values that are negligible
};

}  // namespace contrejour::inline internal::screens
