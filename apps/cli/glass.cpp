// SPDX-License-Identifier: Apache-2.0
// contrejour glass: queries of glasses.
#include "cli/command.h"

namespace contrejour::cli {

void add_glass(CLI::App& app, Action& action) {
  CLI::App* glass = app.add_subcommand("glass", "list and describe optical glasses, find the closest");
  glass->require_subcommand(1);
  glass->footer(
      "Examples:\n"
      "  contrejour glass list --maker SCHOTT\n"
      "  contrejour glass show N-BK7\n"
      "  contrejour glass closest 1.62 36.4\n\n"
      "CONTREJOUR_GLASS_PATH may name files and folders of your own catalogues, which come before the bundled one.");
  add_glass_list(*glass, action);
  add_glass_show(*glass, action);
  add_glass_closest(*glass, action);
}

}  // namespace contrejour::cli
