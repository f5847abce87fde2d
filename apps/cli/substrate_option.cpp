// SPDX-License-Identifier: Apache-2.0
#include "cli/substrate_option.h"

#include <fmt/format.h>

#include "cli/glass_choice.h"
#include "contrejour/expert/glass_text.h"

namespace contrejour::cli {

void add_substrate_option(CLI::App& command, std::string& text) {
  text = "N-BK7";
  command
      .add_option(
          "--glass", text,
          fmt::format("the substrate: a glass of the catalogue, an index, or n_d and Abbe number (default: {})", text))
      ->option_text("NAME|N|N_D,V_D");
}

Result<Glass> parse_substrate(const std::string& text) {
  const auto glasses = all_glasses();
  if (!glasses) return tl::unexpected(glasses.error());
  return params::parse_glass(text, *glasses);
}

}  // namespace contrejour::cli
