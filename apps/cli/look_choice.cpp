// SPDX-License-Identifier: Apache-2.0
#include "cli/look_choice.h"

#include "cli/options.h"

namespace contrejour::cli {

void add_look_options(CLI::App& command, LookOptions& options) {
  command
      .add_option("--look,--preset", options.look,
                  "the preset to start from: a bundled one (`contrejour look list`) or a file; other options override "
                  "its settings")
      ->option_text("PRESET");
  add_output(command, "--save-look,--save-preset", options.save, {".toml"},
             "save all settings of this flare as a preset");
}

Result<void> fill_from_look(const LookOptions& options, std::string& lens, params::Values& values) {
  if (options.look.empty()) return {};
  const auto look = params::find_look(options.look);
  if (!look) return tl::unexpected(look.error());
  values = values.over(look->values);
  if (lens.empty()) lens = look->lens;
  if (!lens.empty()) return {};
  return failure(ErrorCode::InvalidArgument, "the preset names no lens; give a LENS (`contrejour lens list`)");
}

}  // namespace contrejour::cli
