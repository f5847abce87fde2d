// SPDX-License-Identifier: Apache-2.0
// How often a task of milliseconds is repeated: a machine is slower at first, and other programs use it.
#pragma once

namespace contrejour::cli {

// At least as many runs as requested; from two on, runs are repeated until they have taken some time in total.
[[nodiscard]] constexpr bool another_run(int done, int asked, double all_ms) {
  constexpr double kWarm_ms = 300.0;
  return done < asked || (asked > 1 && all_ms < kWarm_ms);
}

}  // namespace contrejour::cli
