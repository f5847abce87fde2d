// Rows of `bench tables` as JSON.
#pragma once

#include "cli/bench/rows.h"
#include "cli/console.h"

namespace contrejour::cli {

[[nodiscard]] Json bench_json(const BenchRows& rows);

// What it was measured on, in a line.
[[nodiscard]] std::string machine_text();

}  // namespace contrejour::cli
