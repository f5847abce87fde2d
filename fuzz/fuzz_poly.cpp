// SPDX-License-Identifier: Apache-2.0
// Any bytes as a file of polynomials: what is read is written as the same values, and evaluates without reading beyond
// its coefficients.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "contrejour/expert/direct_polynomials.h"
#include "contrejour/expert/polynomial_range.h"

namespace {

using namespace contrejour;

void demand(bool holds) {
  if (!holds) std::abort();
}

void read_direct(std::string_view bytes) {
  const auto read = read_direct_polynomials(bytes, "fuzz.poly");
  if (!read) return;
  const std::string written = write_direct_polynomials(*read);
  const auto again = read_direct_polynomials(written, "again.poly");
  demand(again.has_value() && write_direct_polynomials(*again) == written);
  static_cast<void>(direct_ray(*read, {0.1 * read->max_height_mm, 0.2 * read->max_height_mm}, {0.1, -0.2}, 550.0));
  static_cast<void>(direct_sensor_point(*read, {{1.0, 2.0, read->front_z_mm - 100.0}}, {0.1, -0.2}, 550.0));
  demand(read_direct_polynomials(write_direct_polynomials(at_wavelength(*read, 500.0)), "one.poly").has_value());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  read_direct({reinterpret_cast<const char*>(data), size});
  const auto any = read_any_polynomials({reinterpret_cast<const char*>(data), size}, "fuzz.poly");
  if (!any) return 0;
  if (const auto* const range = std::get_if<LensPolynomialRange>(&*any)) {
    const std::string bytes = write_polynomial_range(*range);
    const auto again = read_any_polynomials(bytes, "again.poly");
    demand(again.has_value() && write_polynomial_range(std::get<LensPolynomialRange>(*again)) == bytes);
    const double fraction = traced_flux_fraction(*range);
    demand(fraction >= 0.0 && fraction <= 1.0);
    return 0;
  }
  const LensPolynomials* const read = &std::get<LensPolynomials>(*any);
  const std::string written = write_polynomials(*read);
  const auto again = read_polynomials(written, "again.poly");
  demand(again.has_value() && write_polynomials(*again) == written);
  const double traced = traced_flux_fraction(*read);
  demand(traced >= 0.0 && traced <= 1.0);
  for (const GhostPolynomials& ghost : read->ghosts)
    for (const AsymmetricZone& zone : ghost.asymmetric) {
      demand(area_of(ghost, zone) > 0.0);
      static_cast<void>(evaluate(*read, ghost, zone.high, {0.1, 0.2}, 550.0));
    }
  for (const GhostPolynomials& ghost : read->ghosts)
    for (const PolynomialZone& zone : ghost.zones)
      if (zone.state == PolynomialZone::State::Fitted)
        static_cast<void>(evaluate(*read, zone, zone.field_high, {0.1, 0.2}, 550.0));
  return 0;
}
