// Figures of `bench tables` that have to hold: ratios of one run on one machine, and what they are held to.
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
  std::string note{};  // what it was made from
};

// "aim" where the aim holds, "yes" where only what must hold does, else "no".
[[nodiscard]] std::string holds_text(const Target& target);

[[nodiscard]] std::string targets_text(const std::vector<Target>& targets);

// How many times faster one measurement is than the other of the same system.
[[nodiscard]] Target speed_target(const BenchRow& slow, const BenchRow& fast, double must, double aim);

}  // namespace contrejour::cli
