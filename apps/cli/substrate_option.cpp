// SPDX-License-Identifier: Apache-2.0
#include "cli/substrate_option.h"

#include <fmt/format.h>

#include "cli/glass_choice.h"
#include "contrejour/expert/parameter_text.h"

namespace contrejour::cli {

void add_substrate_option(CLI::App& command, std::string& text) {
  text = "N-BK7";
  command
      .add_option(
          "--glass", text,
          fmt::format("the substrate: a glass of the catalogue, an index, or n_d and Abbe number (default: {})", text))
      ->option_text("NAME|N|N_D,V_D");
}

// A glass code of six digits, an index, n_d and Abbe number, or else a name.
Result<Glass> parse_substrate(const std::string& text) {
  if (const auto coded = glass_of_code(text)) return *coded;
  const std::size_t comma = text.find(',');
  const auto n = params::parse_real(text.substr(0, comma));
  if (!n) {
    const auto glasses = all_glasses();
    if (!glasses) return tl::unexpected(glasses.error());
    auto entry = glasses->find(text);
    if (!entry) return tl::unexpected(entry.error());
    return entry->glass;
  }
  const auto v = comma == std::string::npos ? Result<double>(0.0) : params::parse_real(text.substr(comma + 1));
  if (!v || !(*n >= 1.0 && *n <= 4.0) || !(*v == 0.0 || (*v >= 10.0 && *v <= 150.0))) {
    return failure(
        ErrorCode::InvalidArgument,
        fmt::format("\"{}\" is not a glass; give a name such as N-BK7, an index from 1 to 4, or n_d and an Abbe "
                    "number from 10 to 150 as in 1.5168,64.17",
                    text));
  }
  return Glass{text, AbbeGlass{*n, *v}};
}

}  // namespace contrejour::cli
