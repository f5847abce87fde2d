// SPDX-License-Identifier: Apache-2.0
#include "settings/parse_rgb.h"

#include <algorithm>

#include <fmt/format.h>

#include "contrejour/expert/parameter_text.h"

namespace contrejour::params {

Result<Rgb> parse_rgb(std::string_view text, double max) {
  const auto numbers = parse_reals(text, 3);
  if (!numbers) return tl::unexpected(numbers.error());
  const auto [smallest, largest] = std::minmax_element(numbers->begin(), numbers->end());
  if (*smallest < 0.0)
    return invalid_argument(fmt::format("\"{}\" has a negative channel; give channels of 0 or more", text));
  if (*largest > max)
    return invalid_argument(fmt::format("\"{}\" has a channel above the limit of {:.0e}; give less", text, max));
  return Rgb{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

}  // namespace contrejour::params
