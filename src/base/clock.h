// Measures elapsed time.
#pragma once

#include <chrono>

namespace contrejour {

using Clock = std::chrono::steady_clock;

[[nodiscard]] inline double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace contrejour
