// SPDX-License-Identifier: Apache-2.0
// Adds the time until the end of the block to a sum.
#pragma once

#include "base/clock.h"

namespace contrejour::inline internal::bundle {

class Stopwatch {
 public:
  explicit Stopwatch(double& sum_ms) : sum_ms_(sum_ms) {}
  ~Stopwatch() { sum_ms_ += elapsed_ms(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

  [[nodiscard]] double elapsed_ms() const { return ms_since(start_); }

 private:
  Clock::time_point start_ = Clock::now();
  double& sum_ms_;
};

}  // namespace contrejour::inline internal::bundle
