// SPDX-License-Identifier: Apache-2.0
// Rows and targets of `bench` as JSON.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/bench/rows.h"
#include "cli/bench/target.h"
#include "cli/console.h"
#include "cli/outputs.h"

namespace contrejour::cli {

[[nodiscard]] Json bench_json(const BenchRows& rows, const std::vector<Target>& targets);

// The file that --json names, if any.
class BenchFile {
 public:
  [[nodiscard]] Result<void> open(const std::string& destination);  // before long work; "": none
  [[nodiscard]] Result<void> write(const BenchRows& rows, const std::vector<Target>& targets);

 private:
  Outputs outputs_;
  OutputFile* file_ = nullptr;  // null: not requested
};

// The machine of the measurement, in one line.
[[nodiscard]] std::string machine_text();

}  // namespace contrejour::cli
