#include "optics/lens/plain_number.h"

#include <charconv>
#include <cmath>
#include <string>

namespace contrejour {

std::optional<double> plain_number(std::string_view cell) {
  constexpr std::size_t kLongest = 64;
  if (cell.starts_with('+')) cell.remove_prefix(1);
  if (cell.empty() || cell.size() > kLongest || cell.front() == '+') return std::nullopt;
  std::string text(cell);
  for (char& c : text)
    if (c == 'D' || c == 'd') c = 'e';
  double value = 0.0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end != text.data() + text.size()) return std::nullopt;
  if (status == std::errc::result_out_of_range && text.find("e-") != std::string::npos) return 0.0;
  if (status != std::errc{} || !(std::abs(value) <= kLargestNumber)) return std::nullopt;
  return value + 0.0;  // -0 is 0
}

double curvature_of_radius(double radius_mm) {
  return radius_mm == 0.0 || !(std::abs(radius_mm) <= kLargestNumber) ? 0.0 : 1.0 / radius_mm;
}

double tidy_curvature(double curvature_per_mm) {
  return std::abs(curvature_per_mm) < 1.0 / kLargestNumber ? 0.0 : curvature_per_mm;
}

}  // namespace contrejour
