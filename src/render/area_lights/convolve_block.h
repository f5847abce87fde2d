// SPDX-License-Identifier: Apache-2.0
// The innermost loops of a convolution, vectorised.
#pragma once

#include <cstddef>
#include <span>

namespace contrejour::inline internal::area {

inline constexpr std::size_t kBlockFloats = 48;    // 16 pixels of three channels
inline constexpr std::size_t kPatternFloats = 24;  // numbers after which channels and vectors of 8 begin together again

// A row of a kernel applied to a row of a picture: pixel p of the block takes from[3 * (p - k)] for each weight k.
struct BlockTerm {
  const float* from = nullptr;
  const float* weights = nullptr;  // one each, or three for the channels, repeated to kPatternFloats
  std::size_t count = 0;
};

// Whether any of a block's values is not 0.
[[nodiscard]] bool has_light(const float* block);
// Whether any second difference of a block, along a row or across rows, exceeds `threshold`. The block has a pixel
// before and after it.
[[nodiscard]] bool is_curved(const float* above, const float* block, const float* below, float threshold);

void add_block(std::span<const BlockTerm> terms, float* to);  // one weight for all channels
void add_coloured_block(std::span<const BlockTerm> terms, float* to);  // a weight for each channel

}  // namespace contrejour::inline internal::area
