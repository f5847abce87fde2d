// SPDX-License-Identifier: Apache-2.0
// contrejour farm: the frames of a sequence on several machines.
#include "cli/command.h"

namespace contrejour::cli {

void add_farm(CLI::App& app, Action& action) {
  CLI::App* farm = app.add_subcommand("farm", "render the frames of a sequence on several machines");
  farm->require_subcommand(1);
  farm->footer(
      "After --, give the command as you would run it on one machine. Its frames are divided into chunks. A frame\n"
      "that is done is not rendered again. All machines need the program and the files under the same names.\n\n"
      "Examples:\n"
      "  contrejour farm slurm --submit --wait -- apply heliar plate.####.exr -o out.####.exr\n"
      "  contrejour farm commands --chunk 5 -- render heliar -o flare.####.exr --frames 1-48 --lights lights.toml");
  add_farm_slurm(*farm, action);
  add_farm_commands(*farm, action);
}

}  // namespace contrejour::cli
