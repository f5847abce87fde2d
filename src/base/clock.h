// SPDX-License-Identifier: Apache-2.0
// Measures elapsed time.
#pragma once

#include <chrono>

namespace contrejour::inline internal {

using Clock = std::chrono::steady_clock;

[[nodiscard]] inline double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace contrejour::inline internal
