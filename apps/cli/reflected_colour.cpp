// SPDX-License-Identifier: Apache-2.0
#include "cli/reflected_colour.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "contrejour/expert/parameter_text.h"

namespace contrejour::cli {
namespace {

constexpr double kColourFirst_nm = 380.0, kColourLast_nm = 780.0, kColourStep_nm = 5.0;

// The sRGB transfer function, IEC 61966-2-1.
double encoded(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}
double decoded(double code) { return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4); }

std::optional<Rgb> parse_hex(const std::string& text) {
  if (text.size() != 7 || text[0] != '#') return std::nullopt;
  Rgb rgb{};
  for (std::size_t c = 0; c < 3; ++c) {
    int code = 0;
    const char* const first = text.data() + 1 + 2 * c;
    const auto [end, status] = std::from_chars(first, first + 2, code, 16);
    if (status != std::errc{} || end != first + 2) return std::nullopt;
    rgb[c] = decoded(code / 255.0);
  }
  return rgb;
}

}  // namespace

std::vector<double> reflected_wavelengths_nm() {
  std::vector<double> nm;
  for (double l = kColourFirst_nm; l <= kColourLast_nm; l += kColourStep_nm) nm.push_back(l);
  return nm;
}

Xyz reflected_colour(std::span<const double> reflectance) {
  Xyz sum{};
  double white = 0.0;
  double nm = kColourFirst_nm;
  for (const double r : reflectance) {
    const Xyz observer = colour_matching(nm);
    const double power = spectral_power(IlluminantD65{}, nm);
    for (std::size_t c = 0; c < 3; ++c) sum[c] += r * power * observer[c];
    white += power * observer[1];
    nm += kColourStep_nm;
  }
  for (double& v : sum) v /= white;
  return sum;
}

std::string srgb_text(const Xyz& xyz) {
  Rgb rgb = rgb_from_xyz(xyz, ColourSpace::Rec709);
  const double max = *std::max_element(rgb.begin(), rgb.end());
  std::string text = "#";
  for (const double v : rgb)
    text += fmt::format("{:02x}", std::lround(255.0 * (max > 0.0 ? encoded(std::clamp(v / max, 0.0, 1.0)) : 0.0)));
  return text;
}

Result<std::array<double, 2>> parse_chromaticity(const std::string& text) {
  auto rgb = parse_hex(text);
  if (!rgb) {
    const auto numbers = params::parse_light_value(text);
    if (!numbers || text.find(',') == std::string::npos) {
      return failure(ErrorCode::InvalidArgument,
                     fmt::format("\"{}\" is not a colour; give #rrggbb as in a picture, or scene-linear R,G,B", text));
    }
    rgb = numbers->rgb;
  }
  const Xyz xyz = xyz_from_rgb(*rgb, ColourSpace::Rec709);
  if (!(xyz[0] + xyz[1] + xyz[2] > 0.0))
    return failure(ErrorCode::InvalidArgument, fmt::format("\"{}\" is black; give the colour of a reflection", text));
  return chromaticity(xyz);
}

}  // namespace contrejour::cli
