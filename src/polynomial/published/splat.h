// SPDX-License-Identifier: Apache-2.0
// Adds the light of rays to pixels, each ray's to the four nearest ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/vec.h"
#include "contrejour/image.h"

namespace contrejour::inline internal::polynomial {

struct SplatTarget {
  int width = 0, height = 0;
  Vec2 half_size;  // of the picture about the origin
  std::vector<double> pixels;  // rows from the top

  SplatTarget(int w, int h, Vec2 half)
      : width(w), height(h), half_size(half), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  void add(Vec2 at, double weight);
  void add(const SplatTarget& other);
  [[nodiscard]] Image image() const;  // of one channel
};

struct SplatRay {
  Vec2 at;  // on the sensor
  double weight = 1.0;
};
// The ray at a point of the unit square; none if it is blocked.
using RayAt = std::function<std::optional<SplatRay>(Vec2 unit)>;

struct SplatPoints {
  int side = 1;  // side^2 rays: one somewhere in each cell of a grid
  bool random = false;  // all of them anywhere instead
  std::uint64_t seed = 1;
};

// Adds rays, each with `weight` over their number times its own. The same sums for any number of threads. False if
// cancelled.
bool splat(SplatTarget& target, const RayAt& ray, const SplatPoints& points, double weight, const Context& context);

}  // namespace contrejour::inline internal::polynomial
