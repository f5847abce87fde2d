// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include "contrejour/expert/polynomial.h"
#include "polynomial/export_code.h"
#include "polynomial/export_tables.h"

namespace contrejour::inline internal::polynomial {
namespace {

// The tables of the exported ghosts. `parts` holds the first polynomial, the crossings and the rims of each
// zone, the first of its fields and how many these are; `fields` the bounds of the light at each field.
struct ExportTables {
  SumTables polynomials;
  std::vector<int> first_zone{0}, parts;
  std::vector<double> zones, fields;

  void add(const PolynomialZone& zone) {
    for (const double value : {zone.field_low, zone.field_high, zone.centre_mm, zone.centre_slope_mm, zone.radius_mm})
      zones.push_back(value);
    for (const std::size_t value :
         {polynomials.sums.size() / 3, zone.stop.size(), zone.rims.size(), fields.size() / 4, zone.bounds.size()})
      parts.push_back(static_cast<int>(value));
    for (const PolynomialBounds& at : zone.bounds)
      for (const float value : {at.field, at.low_x_mm, at.high_x_mm, at.half_y_mm}) fields.push_back(value);
    polynomials.add(zone.sensor_mm);
    for (const ChebyshevVector& crossing : zone.stop) polynomials.add(crossing);
    for (const PolynomialRim& rim : zone.rims) polynomials.add(rim.squared);
    polynomials.add(zone.transmittance);
  }
  void add(const GhostPolynomials& ghost) {
    for (const PolynomialZone& zone : ghost.zones)
      if (zone.state == PolynomialZone::State::Fitted) add(zone);
    first_zone.push_back(static_cast<int>(parts.size() / 5));
  }
};

std::string header_text(const LensPolynomials& polynomials, const std::vector<Ghost>& ghosts,
                        PolynomialLanguage language) {
  const std::string_view comment = language == PolynomialLanguage::Python ? "#" : "//";
  std::string names;
  for (std::size_t k = 0; k < ghosts.size(); ++k)
    names += fmt::format("{} ghost {}: {}\n", comment, k, ghost_name(ghosts[k]));
  return fmt::format(
      "{0} Ghosts of {1}, written by contrejour polynomial export.\n{0} ray(): the light comes from -x, `field` is the "
      "tangent of its angle to the axis.\n{0} bounds(): lowest and highest x and half the height of the part of the "
      "entrance plane in which light enters, mm.\n{0} Entrance plane: z = {2} mm from the first vertex. Stop: widest "
      "radius "
      "{3} "
      "mm.\n{4}",
      comment, one_line(polynomials.lens), polynomials.entrance_z_mm, polynomials.stop_radius_mm, names);
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
                     table_text(language, "int", "sums", tables.polynomials.sums) +
                     table_text(language, is_c ? "double" : "float", "zones", tables.zones) +
                     table_text(language, is_c ? "double" : "float", "fields", tables.fields) +
                     coefficients_text(language, tables.polynomials.coefficients);
  switch (language) {
    case PolynomialLanguage::C: text += kCodeInC; break;
    case PolynomialLanguage::Glsl:
    case PolynomialLanguage::Hlsl: text += kCodeInShaders; break;
    case PolynomialLanguage::Python: text += kCodeInPython; break;
  }
  replace_all(text, "@SHORTEST", inverse_square_text(polynomials.shortest_nm));
  replace_all(text, "@LONGEST", inverse_square_text(polynomials.longest_nm));
  replace_all(text, "@", prefix);
  return header_text(polynomials, ghosts, language) + "\n" + text;
}

}  // namespace contrejour
