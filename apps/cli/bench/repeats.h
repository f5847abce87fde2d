// SPDX-License-Identifier: Apache-2.0
// The number of runs of a task that takes milliseconds. Its first runs are slower, and other programs use the machine.
#pragma once

namespace contrejour::cli {

// At least the requested number of runs. If that is two or more, runs continue until they have taken some time in
// total.
[[nodiscard]] constexpr bool another_run(int done, int requested, double all_ms) {
  constexpr double kWarm_ms = 300.0;
  return done < requested || (requested > 1 && all_ms < kWarm_ms);
}

}  // namespace contrejour::cli
