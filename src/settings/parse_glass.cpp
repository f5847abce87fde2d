// SPDX-License-Identifier: Apache-2.0
#include <string>

#include <fmt/format.h>

#include "contrejour/expert/glass_text.h"
#include "contrejour/expert/parameter_text.h"

namespace contrejour::params {

Result<Glass> parse_glass(std::string_view text, const GlassCatalogue& glasses) {
  if (text == "air") return air();
  if (const auto coded = glass_of_code(text)) return *coded;
  const std::size_t comma = text.find(',');
  const auto n = parse_real(text.substr(0, comma));
  if (!n) {
    auto entry = glasses.find(text);
    if (!entry) return tl::unexpected(entry.error());
    return entry->glass;
  }
  const auto v = comma == std::string_view::npos ? Result<double>(0.0) : parse_real(text.substr(comma + 1));
  if (!v || !(*n >= 1.0 && *n <= 4.0) || !(*v == 0.0 || (*v >= 10.0 && *v <= 150.0))) {
    return invalid_argument(
        fmt::format("\"{}\" is not a glass; give a name such as N-BK7, an index from 1 to 4, or n_d and an Abbe "
                    "number from 10 to 150 as in 1.5168,64.17",
                    text));
  }
  return Glass{std::string(text), AbbeGlass{*n, *v}};
}

}  // namespace contrejour::params
