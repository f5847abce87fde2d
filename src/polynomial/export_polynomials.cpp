// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>

#include "contrejour/expert/polynomial.h"
#include "polynomial/asymmetric_code.h"
#include "polynomial/export_code.h"
#include "polynomial/export_tables.h"

namespace contrejour::inline internal::polynomial {
namespace {

// The tables of the exported ghosts. `parts` holds the first polynomial, the crossings and the rims of each
// zone, the first of its fields and how many these are; `fields` the bounds of the light at each field. Rectangles are
// the zones of ghosts without axial symmetry: `rectangle_parts` holds the first polynomial, the crossings, the rims,
// the first node of `grid`, the nodes of its side, whether it is even in x and in y, and whether it is the mirror image
// of another one along x and y; `grid` the bounds at each node.
struct ExportTables {
  SumTables polynomials;
  std::vector<int> first_zone{0}, parts, first_rectangle{0}, rectangle_parts;
  std::vector<double> zones, fields, rectangles, grid;

  [[nodiscard]] bool has_rectangles() const { return !rectangle_parts.empty(); }
  [[nodiscard]] bool has_zones() const { return !parts.empty() || !has_rectangles(); }

  void add(const PolynomialZone& zone) {
    const double per_end = zone.pupil_end > 0.0 ? 1.0 / (zone.pupil_end * zone.pupil_end) : 0.0;
    for (const double value :
         {zone.field_low, zone.field_high, zone.centre_mm, zone.centre_slope_mm, zone.radius_mm, per_end})
      zones.push_back(value);
    for (const std::size_t value :
         {polynomials.sums.size() / 3, zone.stop.size(), zone.rims.size(), fields.size() / 4, zone.bounds.size()})
      parts.push_back(static_cast<int>(value));
    for (const PolynomialBounds& at : zone.bounds)
      for (const float value : {at.field, at.low_x_mm, at.high_x_mm, at.half_y_mm}) fields.push_back(value);
    add_outputs(zone);
  }
  void add(const AsymmetricZone& zone, const GhostPolynomials& ghost) {
    for (const std::size_t value : {polynomials.sums.size() / 3, zone.stop.size(), zone.rims.size(), grid.size() / 4})
      rectangle_parts.push_back(static_cast<int>(value));
    rectangle_parts.push_back(zone.bounds_side);
    for (const bool value : {zone.even_x, zone.even_y, ghost.mirror_x && !zone.even_x, ghost.mirror_y && !zone.even_y})
      rectangle_parts.push_back(value ? 1 : 0);
    for (const Vec2 value : {zone.low, zone.high, zone.radius_mm})
      for (const double axis : {value.x, value.y}) rectangles.push_back(axis);
    for (const auto* centre : {&zone.centre_x_mm, &zone.centre_y_mm})
      rectangles.insert(rectangles.end(), centre->begin(), centre->end());
    for (const AsymmetricBounds& at : zone.bounds)
      for (const float value : {at.low_x_mm, at.low_y_mm, at.high_x_mm, at.high_y_mm}) grid.push_back(value);
    add_outputs(zone);
  }
  void add(const GhostPolynomials& ghost) {
    for (const PolynomialZone& zone : ghost.zones)
      if (zone.state == PolynomialZone::State::Fitted) add(zone);
    first_zone.push_back(static_cast<int>(parts.size() / 5));
    for (const AsymmetricZone& zone : ghost.asymmetric)
      if (zone.state == PolynomialZone::State::Fitted) add(zone, ghost);
    first_rectangle.push_back(static_cast<int>(rectangle_parts.size() / 9));
  }

 private:
  void add_outputs(const auto& zone) {
    polynomials.add(zone.sensor_mm);
    for (const auto& crossing : zone.stop) polynomials.add(crossing);
    for (const PolynomialRim& rim : zone.rims) polynomials.add(rim.squared);
    polynomials.add(zone.transmittance);
  }
};

constexpr std::string_view kCentredHeader =
    "@@ ray(): the light comes from -x, `field` is the tangent of its angle to the axis.\n"
    "@@ bounds(): lowest and highest x and half the height of the part of the entrance plane in which light enters, "
    "mm.\n";
constexpr std::string_view kAsymmetricHeader =
    "@@ ray_at(): in the lens's frame, for light that travels along (tangent_x, tangent_y, 1).\n"
    "@@ bounds_at(): lowest x, lowest y, highest x and highest y of the part of the entrance plane in which light "
    "enters, mm.\n";

std::string header_text(const LensPolynomials& polynomials, const std::vector<Ghost>& ghosts,
                        const ExportTables& tables, PolynomialLanguage language) {
  std::string text = fmt::format(
      "@@ Ghosts of {}, written by contrejour polynomial export.\n{}{}"
      "@@ Entrance plane: z = {} mm from the first vertex. Stop: widest radius {} mm.\n",
      one_line(polynomials.lens), tables.has_zones() ? kCentredHeader : "",
      tables.has_rectangles() ? kAsymmetricHeader : "", polynomials.entrance_z_mm, polynomials.stop_radius_mm);
  for (std::size_t k = 0; k < ghosts.size(); ++k) text += fmt::format("@@ ghost {}: {}\n", k, ghost_name(ghosts[k]));
  replace_all(text, "@@", language == PolynomialLanguage::Python ? "#" : "//");
  return text;
}

std::string tables_text(const ExportTables& tables, PolynomialLanguage language) {
  const std::string_view number = language == PolynomialLanguage::C ? "double" : "float";
  std::string text = table_text(language, "int", "sums", tables.polynomials.sums);
  if (tables.has_zones())
    text += table_text(language, "int", "first_zone", tables.first_zone) +
            table_text(language, "int", "parts", tables.parts) + table_text(language, number, "zones", tables.zones) +
            table_text(language, number, "fields", tables.fields);
  if (tables.has_rectangles())
    text += table_text(language, "int", "first_rectangle", tables.first_rectangle) +
            table_text(language, "int", "rectangle_parts", tables.rectangle_parts) +
            table_text(language, number, "rectangles", tables.rectangles) +
            table_text(language, number, "grid", tables.grid);
  return text + coefficients_text(language, tables.polynomials.coefficients);
}

std::string functions_text(const ExportTables& tables, PolynomialLanguage language) {
  const bool is_python = language == PolynomialLanguage::Python;
  std::string code(is_python ? kCommonCodeInPython : kCommonCode);
  if (tables.has_zones()) code += is_python ? kCentredCodeInPython : kCentredCode;
  if (tables.has_rectangles()) code += is_python ? kAsymmetricCodeInPython : kAsymmetricCode;
  return is_python ? code : translated(std::move(code), language);
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
    tables.add(*found);
  }
  std::string text = tables_text(tables, language) + functions_text(tables, language);
  replace_all(text, "@SHORTEST", inverse_square_text(polynomials.shortest_nm));
  replace_all(text, "@LONGEST", inverse_square_text(polynomials.longest_nm));
  replace_all(text, "@", prefix);
  const bool takes_roots = tables.has_zones() && language == PolynomialLanguage::C;
  return header_text(polynomials, ghosts, tables, language) + (takes_roots ? "\n#include <math.h>\n\n" : "\n") + text;
}

}  // namespace contrejour
