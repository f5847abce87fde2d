// SPDX-License-Identifier: Apache-2.0
// contrejour glass: commands about optical glasses.
#include "cli/command.h"

namespace contrejour::cli {

void add_glass(CLI::App& app, Action& action) {
  CLI::App* glass = app.add_subcommand("glass", "list, describe and find optical glasses");
  glass->require_subcommand(1);
  glass->footer(
      "Examples:\n"
      "  contrejour glass list --maker SCHOTT\n"
      "  contrejour glass show N-BK7\n"
      "  contrejour glass closest 1.62 36.4\n\n"
      "The environment variable CONTREJOUR_GLASS_PATH may list files and folders of your own catalogues, which take\n"
      "precedence over the bundled one.");
  add_glass_list(*glass, action);
  add_glass_show(*glass, action);
  add_glass_closest(*glass, action);
}

}  // namespace contrejour::cli
