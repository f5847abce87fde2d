// SPDX-License-Identifier: Apache-2.0
// A hash of 64 bits that gives unrelated numbers for neighbouring keys, the same on every platform: random numbers that
// depend on a seed and an index alone, in any order. Source: Steele, Lea & Flood 2014, SplitMix64.
#pragma once

#include <cstdint>

namespace contrejour::inline internal {

inline constexpr std::uint64_t kSplitMixIncrement = 0x9e3779b97f4a7c15U;

// The generator's finaliser. The k-th number of a sequence from `seed` is split_mix(seed + k * kSplitMixIncrement).
[[nodiscard]] constexpr std::uint64_t split_mix(std::uint64_t z) {
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

// From 0 to below 1.
[[nodiscard]] constexpr double unit_interval(std::uint64_t bits) { return static_cast<double>(bits >> 11U) * 0x1p-53; }

}  // namespace contrejour::inline internal
