// SPDX-License-Identifier: Apache-2.0
// Random numbers that are the same everywhere: the standard's distributions differ from library to library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

namespace contrejour::inline internal::polynomial {

class SeededRandom {
 public:
  explicit SeededRandom(std::uint64_t seed) : engine_(seed) {}

  [[nodiscard]] double unit() { return static_cast<double>(engine_() >> 11U) * 0x1p-53; }  // in [0, 1)
  [[nodiscard]] std::size_t below(std::size_t count) {
    return static_cast<std::size_t>(unit() * static_cast<double>(count));
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace contrejour::inline internal::polynomial
