// SPDX-License-Identifier: Apache-2.0
// contrejour bench: measures how fast this machine renders.
#include "cli/command.h"

namespace contrejour::cli {

void add_bench(CLI::App& app, Action& action) {
  CLI::App* bench = app.add_subcommand("bench", "measure how fast this machine renders");
  bench->require_subcommand(1);
  bench->footer(
      "Examples:\n  contrejour bench tables\n  contrejour bench tables --json tables.json\n"
      "  contrejour bench effects --threads 2\n  contrejour bench flicker --frames 40 --systems heliar");
  add_bench_tables(*bench, action);
  add_bench_effects(*bench, action);
  add_bench_lenses(*bench, action);
  add_bench_hullin(*bench, action);
  add_bench_flicker(*bench, action);
  add_bench_device(*bench, action);
  add_bench_polynomial(*bench, action);
}

}  // namespace contrejour::cli
