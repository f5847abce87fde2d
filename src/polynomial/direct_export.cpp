// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "contrejour/expert/direct_polynomials.h"
#include "polynomial/direct_code.h"
#include "polynomial/export_tables.h"

namespace contrejour::inline internal::polynomial {
namespace {

std::string direct_header(const DirectPolynomials& lens, PolynomialLanguage language) {
  std::string text = fmt::format(
      "@@ Camera rays of {}, written by contrejour polynomial export.\n"
      "@@ Frame: light travels to +z, x right and y up in the scene; camera rays go to -z. mm from the first vertex.\n"
      "@@ Sensor: z = {} mm, points up to {} mm from the axis. Stop: widest radius {} mm, in which stop points are.\n"
      "@@ Focal length {} mm. 95 per cent of the rays land within {:.3g} mm of their sensor point.\n"
      "@@ ray(): x, y, z of origin and direction, transmittance, largest squared height at rims (> 1: blocked), "
      "weight:\n"
      "@@ irradiance = integral of radiance * transmittance * weight over the opening, the widest being the unit "
      "disc.\n"
      "@@ sensor(): x and y for the scene's point (x, y, z) with w = 1, or for the direction (x, y, z) with w = 0.\n",
      one_line(lens.lens), lens.sensor_z_mm, lens.max_height_mm, lens.stop_radius_mm, lens.focal_length_mm,
      lens.accuracy.sensor_p95_px * lens.pixel_mm);
  replace_all(text, "@@", language == PolynomialLanguage::Python ? "#" : "//");
  return text;
}

// A number as a literal of any of the languages.
std::string literal(double value) {
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return value < 0.0 ? "(" + text + ")" : text;
}

}  // namespace
}  // namespace contrejour::inline internal::polynomial

namespace contrejour {

using namespace polynomial;

Result<std::string> export_direct_polynomials(const DirectPolynomials& polynomials, PolynomialLanguage language,
                                              std::string_view prefix) {
  if (!is_identifier(prefix))
    return invalid_argument(fmt::format("'{}' cannot begin a name; choose letters, digits and _", prefix));
  SumTables tables;
  for (const ChebyshevVector* vector : {&polynomials.origin_mm, &polynomials.direction, &polynomials.inner})
    tables.add(*vector);
  tables.add(polynomials.transmittance);
  for (const PolynomialRim& rim : polynomials.rims) tables.add(rim.squared);
  const bool is_python = language == PolynomialLanguage::Python;
  std::string code = is_python ? std::string(kDirectCodeInPython) : translated(std::string(kDirectCode), language);
  const bool in_double = is_python || language == PolynomialLanguage::C;
  replace_all(code, "@CONVERGED", in_double ? "1e-9" : "1e-5 * @HEIGHT");
  replace_all(code, "@HEIGHT", literal(polynomials.max_height_mm));
  replace_all(code, "@MARGIN", literal(DirectPolynomials::kMargin));
  replace_all(code, "@FRONT", literal(polynomials.front_z_mm));
  replace_all(code, "@SHORTEST", inverse_square_text(polynomials.shortest_nm));
  replace_all(code, "@LONGEST", inverse_square_text(polynomials.longest_nm));
  replace_all(code, "@COUNT", fmt::format("{}", tables.sums.size() / 3));
  std::string text =
      table_text(language, "int", "sums", tables.sums) + coefficients_text(language, tables.coefficients) + code;
  replace_all(text, "@", prefix);
  const std::string_view first =
      is_python ? "import math\n\n" : (language == PolynomialLanguage::C ? "#include <math.h>\n\n" : "\n");
  return direct_header(polynomials, language) + std::string(first) + text;
}

}  // namespace contrejour
