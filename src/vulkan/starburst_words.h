// SPDX-License-Identifier: Apache-2.0
// How starbursts lie in their buffer, as shaders/starburst/rings.glsl reads them: the records of lights, then patterns.
// Thread-safety: pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "diffraction/placed_starburst.h"
#include "diffraction/starburst_rings.h"

namespace contrejour::inline internal::vulkan {

inline constexpr std::uint32_t kLightWords = 8;
inline constexpr std::uint32_t kPatternsAt = kLightWords * kMostPlacedStarbursts;  // words

// The parameters of the shaders, in their order.
struct StarburstParameters {
  std::uint32_t light_count = 0;
  std::int32_t width = 0, height = 0, first_row = 0;
  std::uint32_t light = 0;
  std::int32_t left = 0, top = 0;
  std::uint32_t sharing = 0;
};

// The pixel in which a light's image lies.
struct ImagePixel {
  std::int32_t x = 0, y = 0;
};
[[nodiscard]] ImagePixel image_pixel(const PlacedStarburst& light);

// patterns_at: by light, the word at which its pattern begins.
[[nodiscard]] std::vector<std::uint32_t> light_words(std::span<const PlacedStarburst> lights,
                                                     std::span<const std::uint32_t> patterns_at);

[[nodiscard]] std::uint64_t pattern_size(const StarburstRings& rings);  // words
void append_pattern(const StarburstRings& rings, std::vector<std::uint32_t>& words);

}  // namespace contrejour::inline internal::vulkan
