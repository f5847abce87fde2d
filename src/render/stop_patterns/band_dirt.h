// SPDX-License-Identifier: Apache-2.0
// The transmittance of dirt for wavelengths that are drawn together, with each one's fraction of each channel's light.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include "render/planning/dirt_screen.h"

namespace contrejour::inline internal::screens {

struct BandDirt {
  struct Part {
    const DirtScreen* screen;
    std::array<float, 3> channel{1.0F, 1.0F, 1.0F};
  };
  std::vector<Part> parts;  // at least one; all are of one plane

  [[nodiscard]] const DirtScreen& first() const { return *parts.front().screen; }
  [[nodiscard]] std::array<double, 3> transmission(std::span<const DirtPlace> places) const {
    std::array<double, 3> all{};
    for (const Part& part : parts) {
      const double passed = part.screen->transmission(places);
      for (std::size_t c = 0; c < 3; ++c) all[c] += passed * part.channel[c];
    }
    return all;
  }
  [[nodiscard]] bool is_clean(Vec2 middle_mm, double radius_mm, std::size_t crossing) const {
    return std::ranges::all_of(parts,
                               [&](const Part& part) { return part.screen->is_clean(middle_mm, radius_mm, crossing); });
  }
  [[nodiscard]] DirtScreen::Edges edges() const { return first().edges(); }
  [[nodiscard]] const DirtField* outlines() const { return parts.size() == 1 ? first().outlines() : nullptr; }
};

}  // namespace contrejour::inline internal::screens
