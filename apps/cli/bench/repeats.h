// How often what takes milliseconds is run: a machine is cold at first, and others use it.
#pragma once

namespace contrejour::cli {

// So many runs as asked for; from two on they are repeated until they took a while all together.
[[nodiscard]] constexpr bool another_run(int done, int asked, double all_ms) {
  constexpr double kWarm_ms = 300.0;
  return done < asked || (asked > 1 && all_ms < kWarm_ms);
}

}  // namespace contrejour::cli
