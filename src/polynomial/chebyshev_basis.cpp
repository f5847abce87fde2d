// SPDX-License-Identifier: Apache-2.0
#include "polynomial/chebyshev_basis.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal::polynomial {

double field_coordinate(const PolynomialZone& zone, double field) {
  const double low = zone.field_low * zone.field_low, high = zone.field_high * zone.field_high;
  return (2.0 * field * field - low - high) / (high - low);
}

double centre_at(const PolynomialZone& zone, double field) {
  return (zone.centre_mm + zone.centre_slope_mm * field_coordinate(zone, field)) * field;
}

ZonePoint zone_point(const PolynomialZone& zone, double field, Vec2 entrance_mm) {
  ZonePoint point;
  point.h = field / zone.field_high;
  point.p = (entrance_mm - Vec2{centre_at(zone, field), 0.0}) * (1.0 / zone.radius_mm);
  point.u = field_coordinate(zone, field);
  point.v = point.h * point.p.x;
  const double squared = dot(point.p, point.p);
  point.w = 2.0 * squared - 1.0;
  const double end = zone.pupil_end;
  point.s = end > 0.0 ? 1.0 - 2.0 * std::sqrt(std::max(1.0 - squared / (end * end), 0.0)) : point.w;
  return point;
}

double wavelength_coordinate(const LensPolynomials& lens, double lambda_nm) {
  const double at = 1.0 / (lambda_nm * lambda_nm);
  const double low = 1.0 / (lens.longest_nm * lens.longest_nm), high = 1.0 / (lens.shortest_nm * lens.shortest_nm);
  return (2.0 * at - low - high) / (high - low);
}

double wavelength_at(const LensPolynomials& lens, double coordinate) {
  const double low = 1.0 / (lens.longest_nm * lens.longest_nm), high = 1.0 / (lens.shortest_nm * lens.shortest_nm);
  return 1.0 / std::sqrt(0.5 * (low + high + coordinate * (high - low)));
}

void term_values(int degree, const ZonePoint& point, std::span<double> out) {
  std::array<double, kMaxDegree + 1> u{}, v{}, w{};
  chebyshev_values(point.u, u);
  chebyshev_values(point.v, v);
  chebyshev_values(point.w, w);
  std::size_t at = 0;
  for_each_term(degree, [&](int kv, int kw, int ku) {
    out[at++] = v[static_cast<std::size_t>(kv)] * w[static_cast<std::size_t>(kw)] * u[static_cast<std::size_t>(ku)];
  });
}

double value_by_terms(const ChebyshevSum& sum, std::span<const double> terms, double wavelength) {
  std::array<double, kMaxWavelengthTerms> by_wavelength{};
  chebyshev_values(wavelength, by_wavelength);
  const std::size_t count = terms.size();
  double value = 0.0;
  for (std::size_t l = 0; l < static_cast<std::size_t>(sum.wavelength_terms); ++l) {
    double part = 0.0;
    for (std::size_t k = 0; k < count; ++k) part += static_cast<double>(sum.coefficients[l * count + k]) * terms[k];
    value += by_wavelength[l] * part;
  }
  return value;
}

double value_of(const ChebyshevSum& sum, const ZonePoint& point, double wavelength) {
  if (sum.degree < 0) return 0.0;
  std::array<double, static_cast<std::size_t>(term_count(kMaxDegree))> terms{};
  term_values(sum.degree, point, terms);
  return value_by_terms(sum, std::span(terms).first(static_cast<std::size_t>(term_count(sum.degree))), wavelength);
}

}  // namespace contrejour::inline internal::polynomial

namespace contrejour {

PolynomialRay evaluate(const LensPolynomials& polynomials, const PolynomialZone& zone, double field, Vec2 entrance_mm,
                       double lambda_nm) {
  using namespace polynomial;
  const ZonePoint point = zone_point(zone, field, entrance_mm);
  const double wavelength = wavelength_coordinate(polynomials, lambda_nm);
  const ZonePoint of_light = point.of_light();
  const auto vector_at = [&](const ChebyshevVector& vector, const ZonePoint& at) {
    const double along_field = value_of(vector.along_field, at, wavelength);
    return Vec2{at.h * along_field, 0.0} + at.p * value_of(vector.along_pupil, at, wavelength);
  };
  PolynomialRay ray;
  ray.sensor_mm = vector_at(zone.sensor_mm, of_light);
  for (std::size_t c = 0; c < zone.stop.size() && c < ray.stop.size(); ++c)
    ray.stop[c] = vector_at(zone.stop[c], point);
  double squared = 0.0;
  for (const PolynomialRim& rim : zone.rims) squared = std::max(squared, value_of(rim.squared, point, wavelength));
  ray.relative_height = std::sqrt(squared);
  ray.transmittance = value_of(zone.transmittance, of_light, wavelength);
  return ray;
}

const PolynomialZone* find_zone(const GhostPolynomials& ghost, double field) {
  for (const PolynomialZone& zone : ghost.zones)
    if (field >= zone.field_low && field <= zone.field_high) return &zone;
  return nullptr;
}

}  // namespace contrejour
