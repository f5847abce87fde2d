// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/plain_number.h"

#include <cctype>
#include <charconv>
#include <cmath>
#include <string>

namespace contrejour::inline internal {

namespace {

// Reads a number of any size; nothing for other text.
std::optional<double> any_number(std::string_view cell) {
  constexpr std::size_t kLongest = 64;
  if (cell.starts_with('+')) cell.remove_prefix(1);
  if (cell.empty() || cell.size() > kLongest || cell.front() == '+') return std::nullopt;
  std::string text(cell);
  for (char& c : text)
    if (c == 'D' || c == 'd') c = 'e';
  double value = 0.0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return std::nullopt;
  if (status == std::errc::result_out_of_range) {
    if (text.find("e-") != std::string::npos) return 0.0;
    return text.front() == '-' ? -kInfinity : kInfinity;
  }
  if (status != std::errc{}) return std::nullopt;
  return value + 0.0;  // -0 is 0
}

}  // namespace

std::optional<double> plain_number(std::string_view cell) {
  const auto value = any_number(cell);
  return value && std::abs(*value) <= kLargestNumber ? value : std::nullopt;
}

std::optional<double> number_or_infinity(std::string_view cell) {
  std::string lower(cell.substr(0, 16));
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (lower == "infinity" || lower == "+infinity") return kInfinity;  // from_chars has "inf"
  if (lower.starts_with("1.#inf")) return kInfinity;                  // as old Windows programs print it
  if (lower.starts_with("-1.#inf")) return -kInfinity;
  const auto value = any_number(cell);
  if (!value || std::isnan(*value)) return std::nullopt;
  return std::abs(*value) <= kLargestNumber ? *value : std::copysign(kInfinity, *value);
}

double curvature_of_radius(double radius_mm) {
  return radius_mm == 0.0 || !(std::abs(radius_mm) <= kLargestNumber) ? 0.0 : 1.0 / radius_mm;
}

double tidy_curvature(double curvature_per_mm) {
  return std::abs(curvature_per_mm) < 1.0 / kLargestNumber ? 0.0 : curvature_per_mm;
}

}  // namespace contrejour::inline internal
