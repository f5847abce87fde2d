// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/parameter_text.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace contrejour::params {
namespace {

template <class T>
bool read_whole(std::string_view text, T& value) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

bool strip_suffix(std::string_view& text, std::string_view suffix) {
  if (!text.ends_with(suffix)) return false;
  text.remove_suffix(suffix.size());
  return true;
}

}  // namespace

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (true) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

Result<double> parse_real(std::string_view text) {
  double value = 0.0;
  if (!read_whole(text, value) || !std::isfinite(value)) {
    return invalid_argument(fmt::format("\"{}\" is not a number", text));
  }
  return value;
}

Result<int> parse_integer(std::string_view text) {
  int value = 0;
  if (!read_whole(text, value)) {
    return invalid_argument(fmt::format("\"{}\" is not a whole number", text));
  }
  return value;
}

Result<std::vector<double>> parse_reals(std::string_view text, std::size_t count) {
  std::vector<double> values;
  for (const std::string_view part : split(text, ',')) {
    const auto value = parse_real(part);
    if (!value) return tl::unexpected(value.error());
    values.push_back(*value);
  }
  if (values.size() != count) {
    return invalid_argument(
        fmt::format("\"{}\" has {} numbers; give {}, separated by commas", text, values.size(), count));
  }
  return values;
}

Result<int> parse_wavelengths(std::string_view text) {
  if (text == "auto") return kAutoWavelengths;
  int count = 0;
  if (!read_whole(text, count) || count < 1 || count > 1024) {
    return invalid_argument(
        fmt::format("\"{}\" is not a number of wavelengths; give auto, or a number from 1 to 1024", text));
  }
  return count;
}

Result<PixelSize> parse_size(std::string_view text) {
  PixelSize size;
  const std::size_t cross = text.find('x');
  if (cross == std::string_view::npos || !read_whole(text.substr(0, cross), size.width) ||
      !read_whole(text.substr(cross + 1), size.height)) {
    return invalid_argument(
        fmt::format("\"{}\" is not a size; give the width and height in pixels, as in 1920x1080", text));
  }
  if (size.width < 1 || size.height < 1) {
    return invalid_argument(fmt::format("{} has no pixels; width and height must be at least 1", text));
  }
  if (static_cast<double>(size.width) * size.height > kMaxPixels) {
    return invalid_argument(
        fmt::format("{} is too large; a picture may have at most 2^28 pixels, such as 16384x16384", text));
  }
  return size;
}

Result<UvRegion> parse_region(std::string_view text) {
  const auto sides = parse_reals(text, 4);
  if (!sides) return tl::unexpected(sides.error());
  const UvRegion region{{(*sides)[0], (*sides)[1]}, {(*sides)[2], (*sides)[3]}};
  if (region.from.x < region.to.x && region.from.y < region.to.y) return region;
  return invalid_argument(
      fmt::format("\"{}\" is an empty region; give left,top,right,bottom, with left < right and top < "
                  "bottom, as in 0.5,0,1,0.5 for the top right quarter",
                  text));
}

Result<double> parse_distance_mm(std::string_view text) {
  if (text == "inf") return std::numeric_limits<double>::infinity();
  std::string_view number = text;
  double unit_mm = 1.0;
  if (strip_suffix(number, "cm")) {
    unit_mm = 10.0;
  } else if (!strip_suffix(number, "mm") && strip_suffix(number, "m")) {
    unit_mm = 1000.0;
  }
  const auto value = parse_real(number);
  if (!value || !(*value > 0.0) || !std::isfinite(*value * unit_mm)) {
    return invalid_argument(
        fmt::format("\"{}\" is not a distance; give a length above 0, as in 2000 (mm), 200cm or 2m, or inf", text));
  }
  return *value * unit_mm;
}

Result<double> parse_error_bound(std::string_view text) {
  constexpr std::pair<std::string_view, double> kQualities[] = {
      {"preview", 0.01}, {"standard", 0.003}, {"final", 0.001}};
  for (const auto& [name, bound] : kQualities) {
    if (text == name) return bound;
  }
  const auto bound = parse_real(text);
  if (bound && *bound >= 1e-4 && *bound <= 0.1) return *bound;
  return invalid_argument(fmt::format(
      "\"{}\" is not an error bound; give preview, standard or final, or a number from 0.0001 to 0.1", text));
}

}  // namespace contrejour::params
