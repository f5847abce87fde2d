// SPDX-License-Identifier: Apache-2.0
// The transmittance of dirt for wavelengths that are drawn together, with each one's fraction of each channel's light.
// Units: mm of the dirt's plane. Thread-safety: const members may run at once.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "render/stop_patterns/dirt_shadows.h"

namespace contrejour::inline internal::stop_patterns {

struct BandDirt {
  struct Part {
    const DirtShadows* shadows;
    std::array<float, 3> channel{1.0F, 1.0F, 1.0F};
  };
  std::vector<Part> parts;  // at least one; all are of one plane

  [[nodiscard]] const DirtShadows& first() const { return *parts.front().shadows; }
  [[nodiscard]] std::array<double, 3> transmission(std::span<const DirtPoint> points) const {
    std::array<double, 3> all{};
    for (const Part& part : parts) {
      const double transmitted = part.shadows->transmission(points);
      for (std::size_t c = 0; c < 3; ++c) all[c] += transmitted * part.channel[c];
    }
    return all;
  }
  [[nodiscard]] bool is_clean(Vec2 middle_mm, double radius_mm, std::size_t crossing) const {
    return std::ranges::all_of(
        parts, [&](const Part& part) { return part.shadows->is_clean(middle_mm, radius_mm, crossing); });
  }
  [[nodiscard]] DirtEdges edges() const { return first().edges(); }
  [[nodiscard]] const DirtField* outlines() const { return parts.size() == 1 ? first().outlines() : nullptr; }
};

}  // namespace contrejour::inline internal::stop_patterns
