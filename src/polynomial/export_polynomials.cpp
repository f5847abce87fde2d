// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cctype>

#include <fmt/format.h>

#include "contrejour/expert/polynomial.h"
#include "polynomial/export_code.h"

namespace contrejour::inline internal::polynomial {
namespace {

// The tables of the exported ghosts. `sums` holds the degree, the wavelength terms and the first coefficient of each
// polynomial; `parts` the first polynomial, the crossings and the rims of each zone.
struct ExportTables {
  std::vector<int> first_zone{0}, parts, sums;
  // As double, whose decimals are exact: Python has no float.
  std::vector<double> zones, coefficients;

  void add(const ChebyshevSum& sum) {
    for (const int value : {sum.degree, sum.wavelength_terms, static_cast<int>(coefficients.size())})
      sums.push_back(value);
    coefficients.insert(coefficients.end(), sum.coefficients.begin(), sum.coefficients.end());
  }
  void add(const ChebyshevVector& vector) {
    add(vector.along_field);
    add(vector.along_pupil);
  }
  void add(const PolynomialZone& zone) {
    for (const double value : {zone.field_low, zone.field_high, zone.centre_mm, zone.centre_slope_mm, zone.radius_mm})
      zones.push_back(value);
    for (const std::size_t value : {sums.size() / 3, zone.stop.size(), zone.rims.size()})
      parts.push_back(static_cast<int>(value));
    add(zone.sensor_mm);
    for (const ChebyshevVector& crossing : zone.stop) add(crossing);
    for (const PolynomialRim& rim : zone.rims) add(rim.squared);
    add(zone.transmittance);
  }
  void add(const GhostPolynomials& ghost) {
    for (const PolynomialZone& zone : ghost.zones)
      if (zone.state == PolynomialZone::State::Fitted) add(zone);
    first_zone.push_back(static_cast<int>(parts.size() / 3));
  }
};

template <class Number>
std::string table_text(PolynomialLanguage language, std::string_view type, std::string_view name,
                       const std::vector<Number>& values) {
  std::string text, line = "  ";
  for (std::size_t k = 0; k < std::max<std::size_t>(values.size(), 1); ++k) {
    const Number value = values.empty() ? Number{} : values[k];  // C and GLSL have no arrays without elements
    std::string number = fmt::format("{}", value);
    const bool is_whole = number.find_first_of(".en") == std::string::npos;
    if (!std::is_integral_v<Number> && is_whole) number += ".0";
    if (line.size() + number.size() > 116) {
      text += line + "\n";
      line = "  ";
    }
    line += number + ", ";
  }
  text += line;
  // GLSL allows no comma behind the last element.
  if (language == PolynomialLanguage::Glsl) text.resize(text.size() - 2);
  switch (language) {
    case PolynomialLanguage::C: return fmt::format("static const {} @{}[] = {{\n{}\n}};\n", type, name, text);
    case PolynomialLanguage::Glsl:
      return fmt::format("const {0} @{1}[{2}] = {0}[{2}](\n{3}\n);\n", type, name,
                         std::max<std::size_t>(values.size(), 1), text);
    case PolynomialLanguage::Python: break;
  }
  return fmt::format("@{} = (\n{}\n)\n", name, text);
}

std::string header_text(const LensPolynomials& polynomials, const std::vector<Ghost>& ghosts,
                        PolynomialLanguage language) {
  const std::string_view comment = language == PolynomialLanguage::Python ? "#" : "//";
  std::string names;
  for (std::size_t k = 0; k < ghosts.size(); ++k)
    names += fmt::format("{} ghost {}: {}\n", comment, k, ghost_name(ghosts[k]));
  std::string lens = polynomials.lens;  // a comment of one line
  std::ranges::replace_if(lens, [](unsigned char c) { return std::iscntrl(c) != 0 || c == '\\'; }, ' ');
  return fmt::format(
      "{0} Ghosts of {1}, written by contrejour polynomial export.\n{0} ray(): the light comes from -x, `field` is the "
      "tangent of its angle to the axis.\n{0} Entrance plane: z = {2} mm from the first vertex. Stop: widest radius "
      "{3} "
      "mm.\n{4}",
      comment, lens, polynomials.entrance_z_mm, polynomials.stop_radius_mm, names);
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

bool is_identifier(std::string_view name) {
  const auto fits = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  return !name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) == 0 &&
         std::ranges::all_of(name, fits);
}

}  // namespace
}  // namespace contrejour::inline internal::polynomial

namespace contrejour {

using namespace polynomial;

Result<std::string> export_polynomials(const LensPolynomials& polynomials, const std::vector<Ghost>& ghosts,
                                       PolynomialLanguage language, std::string_view prefix) {
  if (!is_identifier(prefix))
    return invalid_argument(fmt::format("'{}' cannot begin a name; choose letters, digits and _", prefix));
  ExportTables tables;
  for (const Ghost& ghost : ghosts) {
    const auto found = std::ranges::find(polynomials.ghosts, ghost, &GhostPolynomials::ghost);
    if (found == polynomials.ghosts.end())
      return invalid_argument(fmt::format("the fit has no ghost {}", ghost_name(ghost)));
    if (!found->asymmetric.empty())
      return invalid_argument(
          fmt::format("ghost {} has no axial symmetry; only ghosts of centred lenses of revolution are exported",
                      ghost_name(ghost)));
    tables.add(*found);
  }
  const bool is_c = language == PolynomialLanguage::C;
  std::string text = table_text(language, "int", "first_zone", tables.first_zone) +
                     table_text(language, "int", "parts", tables.parts) +
                     table_text(language, "int", "sums", tables.sums) +
                     table_text(language, is_c ? "double" : "float", "zones", tables.zones) +
                     table_text(language, "float", "coefficients", tables.coefficients);
  switch (language) {
    case PolynomialLanguage::C: text += kCodeInC; break;
    case PolynomialLanguage::Glsl: text += kCodeInGlsl; break;
    case PolynomialLanguage::Python: text += kCodeInPython; break;
  }
  const auto inverse_square = [](double nm) { return fmt::format("{}", 1.0 / (nm * nm)); };
  replace_all(text, "@SHORTEST", inverse_square(polynomials.shortest_nm));
  replace_all(text, "@LONGEST", inverse_square(polynomials.longest_nm));
  replace_all(text, "@", prefix);
  return header_text(polynomials, ghosts, language) + "\n" + text;
}

}  // namespace contrejour
