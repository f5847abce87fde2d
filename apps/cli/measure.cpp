// SPDX-License-Identifier: Apache-2.0
// contrejour measure: flare learned from photographs, from the plan of a sweep to the prediction of flare.
#include "cli/command.h"

namespace contrejour::cli {

void add_measure(CLI::App& app, Action& action) {
  CLI::App* measure = app.add_subcommand("measure", "flare from photographs: plan, merge, fit, predict");
  measure->require_subcommand(1);
  measure->footer(
      "Examples:\n"
      "  contrejour measure protocol -o protocol.html --list sweep.csv\n"
      "  contrejour measure merge sweep.csv -o merged\n"
      "  contrejour measure fit merged -o mine.flare.toml --report mine.html\n"
      "  contrejour measure coatings tessar merged -o learnt.toml\n"
      "  contrejour measure adjust tessar merged -o adjusted.toml\n"
      "  contrejour measure predict heliar -f 8 -o safe.svg\n"
      "  contrejour measure demo -o demo");
  add_measure_protocol(*measure, action);
  add_measure_merge(*measure, action);
  add_measure_fit(*measure, action);
  add_measure_predict(*measure, action);
  add_measure_coatings(*measure, action);
  add_measure_adjust(*measure, action);
  add_measure_demo(*measure, action);
}

}  // namespace contrejour::cli
