// SPDX-License-Identifier: Apache-2.0
#include "settings/sensor_format.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "contrejour/expert/nearest_name.h"
#include "contrejour/expert/parameter_text.h"

namespace contrejour::params {
namespace {

constexpr double kMinSide_mm = 0.1, kMaxSide_mm = 1e4;  // the limits of lens files

// Camera gates of film and whole sensors as their makers and manuals state them. Formats that several makers share
// (aps-c, four-thirds, medium-format) differ from camera to camera by some tenths of a millimetre.
constexpr SensorFormat kFormats[] = {
    {"full-frame", 36.0, 24.0},    {"aps-c", 23.6, 15.7},         {"aps-c-canon", 22.3, 14.9},
    {"four-thirds", 17.3, 13.0},   {"one-inch", 13.2, 8.8},       {"two-thirds-inch", 8.8, 6.6},
    {"medium-format", 43.8, 32.9}, {"super35", 24.89, 18.66},     {"super35-3perf", 24.89, 13.87},
    {"academy", 21.95, 16.0},      {"vistavision", 37.72, 24.92}, {"super16", 12.52, 7.41},
    {"65mm", 52.63, 23.01},        {"imax", 70.41, 52.63},        {"alexa35", 27.99, 19.22},
    {"alexa-lf", 36.70, 25.54},    {"alexa65", 54.12, 25.58},     {"venice", 36.2, 24.1},
    {"monstro", 40.96, 21.60},
};

bool is_possible(double side_mm) { return side_mm >= kMinSide_mm && side_mm <= kMaxSide_mm; }

}  // namespace

std::span<const SensorFormat> sensor_formats() { return kFormats; }

Result<SensorFormat> parse_sensor(std::string_view text) {
  const auto* const named = std::ranges::find(kFormats, text, &SensorFormat::name);
  if (named != std::end(kFormats)) return *named;
  const auto sides = split(text, 'x');
  if (sides.size() == 2) {
    const auto width = parse_real(sides[0]), height = parse_real(sides[1]);
    if (width && height && is_possible(*width) && is_possible(*height)) return SensorFormat{{}, *width, *height};
  }
  std::vector<std::string_view> names;
  for (const SensorFormat& format : kFormats) names.push_back(format.name);
  const std::string nearest = nearest_name(text, names);
  return invalid_argument(fmt::format("\"{}\" is not a sensor{}; give its size in mm as 24.9x18.7, or one of {}", text,
                                      nearest.empty() ? "" : fmt::format("; did you mean {}?", nearest),
                                      fmt::join(names, ", ")));
}

}  // namespace contrejour::params
