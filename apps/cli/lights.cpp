// SPDX-License-Identifier: Apache-2.0
// contrejour lights: files of a shot's lights, for `apply --lights`.
#include "cli/command.h"

namespace contrejour::cli {

void add_lights(CLI::App& app, Action& action) {
  CLI::App* lights = app.add_subcommand("lights", "lights of a moving shot: track them, import tracks");
  lights->require_subcommand(1);
  lights->footer(
      "Examples:\n"
      "  contrejour lights track plate.####.exr -o lights.toml\n"
      "  contrejour lights import tracks.txt --size 1920x1080 -o lights.toml\n"
      "  contrejour apply heliar plate.####.exr -o out.####.exr --lights lights.toml");
  add_lights_track(*lights, action);
  add_lights_import(*lights, action);
}

}  // namespace contrejour::cli
