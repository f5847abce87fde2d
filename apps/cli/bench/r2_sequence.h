// SPDX-License-Identifier: Apache-2.0
// Points that fill a frame evenly, however many are taken: a low-discrepancy sequence, always the same.
// Thread-safety: a pure function.
#pragma once

#include <cmath>
#include <cstddef>

#include "contrejour/expert/vec.h"

namespace contrejour::cli {

// The k-th point, u and v from 0 to 1, of the R2 sequence of Roberts 2018 ("The unreasonable effectiveness of
// quasirandom sequences"), whose steps are the powers of 1 / 1.32471795724474602596.
[[nodiscard]] inline Vec2 r2_point(std::size_t k) {
  constexpr double kStep_u = 0.7548776662466927;
  constexpr double kStep_v = 0.5698402909980532;
  const auto n = static_cast<double>(k);
  return {std::fmod(0.5 + n * kStep_u, 1.0), std::fmod(0.5 + n * kStep_v, 1.0)};
}

}  // namespace contrejour::cli
