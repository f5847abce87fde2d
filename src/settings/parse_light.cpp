// SPDX-License-Identifier: Apache-2.0
// Parses lights: their positions, brightness, colours and sizes.
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/spectrum_file.h"
#include "settings/parse_rgb.h"

namespace contrejour::params {
namespace {

constexpr double kMaxLightSize_deg = 90.0;
constexpr std::size_t kMaxPathPositions = 64;
constexpr double kMaxValue = 1e15;  // together with a colour, it hardly exceeds kMaxLightValue
constexpr double kMaxValueStops = 40.0;
constexpr std::pair<std::string_view, LightValue::Unit> kValueUnits[] = {{"stops", LightValue::Unit::Stops},
                                                                         {"lx", LightValue::Unit::Lux},
                                                                         {"nits", LightValue::Unit::Nits},
                                                                         {"cd", LightValue::Unit::Candela}};

bool is_per_channel(std::string_view text) { return text.find(',') != std::string_view::npos; }

// Removes a unit from the end of the text.
LightValue::Unit take_unit(std::string_view& text) {
  for (const auto& [suffix, unit] : kValueUnits) {
    if (!text.ends_with(suffix)) continue;
    text.remove_suffix(suffix.size());
    return unit;
  }
  return LightValue::Unit::Sum;
}

Result<void> check_amount(std::string_view text, double amount, LightValue::Unit unit) {
  const bool is_stops = unit == LightValue::Unit::Stops;
  if (is_stops && std::abs(amount) > kMaxValueStops)
    return invalid_argument(
        fmt::format("{} is out of range; give from -{} to {} stops", text, kMaxValueStops, kMaxValueStops));
  if (!is_stops && amount < 0.0)
    return invalid_argument(fmt::format("{} is negative; give a brightness of 0 or more", text));
  if (amount > kMaxValue)
    return invalid_argument(fmt::format("{} is too large; give a brightness of at most {:.0e}", text, kMaxValue));
  return {};
}

Result<double> parse_light_size(std::string_view text) {
  const auto size_deg = parse_real(text);
  if (!size_deg || (*size_deg >= 0.0 && *size_deg <= kMaxLightSize_deg)) return size_deg;
  return invalid_argument(
      fmt::format("{} is out of range; give a light's diameter from 0 to {} degrees", text, kMaxLightSize_deg));
}

// Reads a part of a light's text into its place. An empty VALUE is left out, and so is an empty part before another.
template <class Parse, class To>
Result<void> read_part(const std::vector<std::string_view>& parts, std::size_t k, Parse parse, To& to) {
  if (k >= parts.size() || (parts[k].empty() && (k == 1 || k + 1 < parts.size()))) return {};
  const auto value = parse(parts[k]);
  if (!value) return tl::unexpected(value.error());
  to = *value;
  return {};
}

// "A,B", or several of them, separated by slashes.
Result<std::vector<Vec2>> parse_path(std::string_view text) {
  const auto positions = split(text, '/');
  if (positions.size() > kMaxPathPositions)
    return invalid_argument(
        fmt::format("a light's path has {} positions; give at most {}", positions.size(), kMaxPathPositions));
  std::vector<Vec2> path;
  for (const std::string_view position : positions) {
    const auto numbers = parse_reals(position, 2);
    if (!numbers) return tl::unexpected(numbers.error());
    path.push_back({(*numbers)[0], (*numbers)[1]});
  }
  return path;
}

}  // namespace

Result<LightValue> parse_light_value(std::string_view text) {
  if (is_per_channel(text)) {
    const auto rgb = parse_rgb(text, kMaxValue);
    if (!rgb) return tl::unexpected(rgb.error());
    return LightValue{*rgb, true};
  }
  std::string_view number = text;
  const LightValue::Unit unit = take_unit(number);
  const auto amount = parse_real(number);
  if (!amount && unit == LightValue::Unit::Sum)
    return invalid_argument(fmt::format(
        "\"{}\" is not a brightness; give the sum of the light's image (5000, or R,G,B), or a number with a "
        "unit, as in 12stops above white, 100000lx at the lens, 800cd or 1.6e9nits",
        text));
  if (!amount) return tl::unexpected(amount.error());
  if (const auto checked = check_amount(text, *amount, unit); !checked) return tl::unexpected(checked.error());
  return LightValue{{*amount, *amount, *amount}, false, unit};
}

Result<LightColour> parse_light_colour(std::string_view text) {
  if (is_per_channel(text)) {
    const auto rgb = parse_rgb(text, kMaxValue);
    if (!rgb) return tl::unexpected(rgb.error());
    return LightColour{IlluminantD65{}, *rgb};
  }
  auto spectrum = find_spectrum(std::string(text));
  if (!spectrum) return tl::unexpected(spectrum.error());
  return LightColour{*spectrum, std::nullopt};
}

Result<LightText> parse_light(std::string_view text) {
  const auto parts = split(text, ':');
  if (parts.size() > 5)
    return invalid_argument(fmt::format("\"{}\" has too many parts; write A,B:VALUE:COLOUR:SIZE:DISTANCE", text));
  auto path = parse_path(parts[0]);
  if (!path) return tl::unexpected(path.error());
  LightText light;
  light.path = std::move(*path);
  for (const Result<void>& read :
       {read_part(parts, 1, parse_light_value, light.value), read_part(parts, 2, parse_light_colour, light.colour),
        read_part(parts, 3, parse_light_size, light.size_deg),
        read_part(parts, 4, parse_distance_mm, light.distance_mm)})
    if (!read) return tl::unexpected(read.error());
  return light;
}

}  // namespace contrejour::params
