// Rows and targets of `bench tables` as JSON.
#pragma once

#include <string>
#include <vector>

#include "cli/bench/rows.h"
#include "cli/bench/target.h"
#include "cli/console.h"

namespace contrejour::cli {

[[nodiscard]] Json bench_json(const BenchRows& rows, const std::vector<Target>& targets);

// What it was measured on, in a line.
[[nodiscard]] std::string machine_text();

}  // namespace contrejour::cli
