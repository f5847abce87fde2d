// SPDX-License-Identifier: Apache-2.0
// Processor time of the whole process: these searches use one thread, on machines that may have other work.
#pragma once

#include <ctime>

namespace contrejour::inline internal::polynomial {

class Stopwatch {
 public:
  [[nodiscard]] double seconds() const { return static_cast<double>(std::clock() - start_) / CLOCKS_PER_SEC; }

 private:
  std::clock_t start_ = std::clock();
};

}  // namespace contrejour::inline internal::polynomial
