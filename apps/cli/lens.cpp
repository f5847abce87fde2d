// SPDX-License-Identifier: Apache-2.0
// contrejour lens: commands about the lens alone.
#include "cli/command.h"

namespace contrejour::cli {

void add_lens(CLI::App& app, Action& action) {
  CLI::App* lens = app.add_subcommand("lens", "list, describe, draw, browse, trace, check and convert lenses");
  lens->require_subcommand(1);
  lens->footer(
      "Examples:\n"
      "  contrejour lens list\n"
      "  contrejour lens info canon-70-200 --focal 135\n"
      "  contrejour lens draw heliar -o heliar.svg --ghost 2,5");
  add_lens_list(*lens, action);
  add_lens_info(*lens, action);
  add_lens_draw(*lens, action);
  add_lens_trace(*lens, action);
  add_lens_browse(*lens, action);
  add_lens_check(*lens, action);
  add_lens_convert(*lens, action);
}

}  // namespace contrejour::cli
