// SPDX-License-Identifier: Apache-2.0
#include <string>
#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/glass_catalogue.h"
#include "contrejour/expert/parameter_text.h"

namespace contrejour::params {

Result<SensorPlate> parse_cover_glass(std::string_view text) {
  const auto parts = split(text, ':');
  SensorPlate plate;
  const auto thickness_mm = parse_real(parts[0]);
  const std::string glass(parts.size() > 1 ? parts[1] : "N-BK7");
  const auto gap_mm = parts.size() > 2 ? parse_real(parts[2]) : Result<double>(plate.gap_mm);
  if (!thickness_mm || !gap_mm || parts.size() > 3) {
    return invalid_argument(
        fmt::format("\"{}\" is not a cover glass; give its thickness in mm, and optionally its glass or index and the "
                    "gap behind it in mm, as in 2, 2:N-BK7 or 2:1.52:0.8",
                    text));
  }
  plate.thickness_mm = *thickness_mm;
  plate.gap_mm = *gap_mm;
  if (const auto n = parse_real(glass)) {
    plate.glass = {glass, ConstantIndex{*n}};
    return plate;
  }
  auto entry = bundled_glasses().find(glass);
  if (!entry) return tl::unexpected(entry.error());
  plate.glass = std::move(entry->glass);
  return plate;
}

}  // namespace contrejour::params
