// SPDX-License-Identifier: Apache-2.0
// Targets of `bench tables`: ratios within one run on one machine, and their limits.
#pragma once

#include <string>
#include <vector>

#include "cli/bench/rows.h"

namespace contrejour::cli {

struct Target {
  std::string name;    // "bundle / adaptive"
  std::string system;  // the paper's name
  int lights = 1;
  double value = 0;
  double must = 0, aim = 0;
  bool more_is_better = false;
  std::string unit{};  // "dB", "ms", "MB"; none: a ratio
  std::string note{};  // the figures that it was computed from
};

// "aim" if the aim is reached, "yes" if only the limit is kept, else "no".
[[nodiscard]] std::string holds_text(const Target& target);

[[nodiscard]] std::string targets_text(const std::vector<Target>& targets);

// The ratio of the times of two measurements of the same system.
[[nodiscard]] Target speed_target(const BenchRow& slow, const BenchRow& fast, double must, double aim);

}  // namespace contrejour::cli
