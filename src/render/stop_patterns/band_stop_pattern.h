// SPDX-License-Identifier: Apache-2.0
// The stop patterns of wavelengths that are drawn together, with each one's fraction of each channel's light.
// Units: stop radii. Thread-safety: const members may run at once.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "contrejour/expert/vec.h"
#include "render/stop_patterns/band_texture.h"
#include "render/stop_patterns/stop_pattern.h"

namespace contrejour::inline internal::stop_patterns {

// The part of a stop pattern that a disc covers: its kind, and about its largest transmittance, at most 1.
struct PatternView {
  PatternRegion part;
  double max_transmittance;
};

struct BandStopPattern {
  struct Part {
    std::shared_ptr<const StopPattern> pattern;
    std::array<float, 3> channel{};
  };
  std::vector<Part> parts;
  [[nodiscard]] bool is_monochrome() const;  // a single part with all light of every channel

  [[nodiscard]] std::array<double, 3> transmittance(std::span<const StopPoint> points) const;
  // Dark or uniform where all parts are.
  [[nodiscard]] PatternView over(Vec2 middle, double radius) const;

  double fringe_unit = 0.1;  // no fringe is much finer
  // The next three describe edges' fringes, which are negligible beyond these distances outside and inside a bound.
  const EdgePattern* edges = nullptr;  // of the first part, if all parts have edges' fringes
  double dark_beyond = 0.0, level_within = 0.0;
  std::shared_ptr<const BandTexture> texture;  // of all parts, if all are patterns of the whole iris
  BoundingPolygon bounding_polygon;  // bounding polygon of such a pattern's visible light
  [[nodiscard]] double brightest(Vec2 middle, double radius) const;
  double negligible_level = 0.0;  // pixel values that are negligible

  // Adds a part. range: the visible range of edges' fringes, in the profile's units; bounding_polygon: the bounding
  // polygon of the visible light, if it is a pattern of the whole iris.
  void add(const Part& part, const EdgeProfile::Range& range, const BoundingPolygon& visible);
  // The textures of all parts; empty if some part has none.
  [[nodiscard]] std::vector<const PatternTexture*> textures() const;
};

}  // namespace contrejour::inline internal::stop_patterns
