// SPDX-License-Identifier: Apache-2.0
// A small picture for the window. Thread-safety: a plain value; reduced_codes() is pure.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace contrejour::studio {

inline constexpr int kThumbnailWidth = 192, kThumbnailHeight = 108;

struct Thumbnail {
  int width = 0, height = 0;
  std::vector<std::uint32_t> rgba;  // bytes R, G, B, A in memory; empty: there is none
};

// At most as large as a thumbnail, in the picture's proportions; one code of each rectangle, which takes no time.
[[nodiscard]] Thumbnail reduced_codes(std::span<const std::uint32_t> rgba, int width, int height);

}  // namespace contrejour::studio
