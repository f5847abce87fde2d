// SPDX-License-Identifier: Apache-2.0
// The basis of ghosts' polynomials: products of Chebyshev polynomials in a light's field and the rotational invariants
// of field and pupil, and in the wavelength. docs/physics/polynomial.md, "Basis".
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "contrejour/expert/polynomial.h"

namespace contrejour::inline internal::polynomial {

inline constexpr int kMaxDegree = 8;  // in u, v and w together: order 17
inline constexpr int kMaxWavelengthTerms = 13;

[[nodiscard]] constexpr int term_count(int degree) { return (degree + 1) * (degree + 2) * (degree + 3) / 6; }
[[nodiscard]] constexpr int pair_count(int degree) { return (degree + 1) * (degree + 2) / 2; }

// Calls visit(v, w, u) for the degrees of each term, in the order of the coefficients.
template <class Visit>
constexpr void for_each_term(int degree, const Visit& visit) {
  for (int v = 0; v <= degree; ++v)
    for (int w = 0; w <= degree - v; ++w)
      for (int u = 0; u <= degree - v - w; ++u) visit(v, w, u);
}

// The values of T_0 to T_degree.
template <std::size_t kCount>
void chebyshev_values(double x, std::array<double, kCount>& out) {
  out[0] = 1.0;
  if constexpr (kCount > 1) out[1] = x;
  for (std::size_t k = 2; k < kCount; ++k) out[k] = 2.0 * x * out[k - 1] - out[k - 2];
}

// A ray's coordinates in a zone: all in [-1, 1] within it.
struct ZonePoint {
  double h = 0.0;  // the field over the zone's highest
  Vec2 p;  // pupil point, |p| <= 1
  double u = 0.0, v = 0.0, w = 0.0;
  double s = 0.0;  // in place of w for positions on the sensor and transmittances

  [[nodiscard]] ZonePoint of_light() const {
    ZonePoint point = *this;
    point.w = s;
    return point;
  }
};
[[nodiscard]] ZonePoint zone_point(const PolynomialZone& zone, double field, Vec2 entrance_mm);
// The coordinate of the field alone, and the centre of the pupil coordinates at it, mm along x.
[[nodiscard]] double field_coordinate(const PolynomialZone& zone, double field);
[[nodiscard]] double centre_at(const PolynomialZone& zone, double field);

// The wavelength's coordinate: linear in 1 / lambda^2, in which dispersion is nearly linear (Cauchy).
[[nodiscard]] double wavelength_coordinate(const LensPolynomials& lens, double lambda_nm);
[[nodiscard]] double wavelength_at(const LensPolynomials& lens, double coordinate);

// All terms at a point, as many as term_count(degree).
void term_values(int degree, const ZonePoint& point, std::span<double> out);

[[nodiscard]] double value_of(const ChebyshevSum& sum, const ZonePoint& point, double wavelength);
// The same with the values of all of a basis' terms at a point, of whichever basis the sum has.
[[nodiscard]] double value_by_terms(const ChebyshevSum& sum, std::span<const double> terms, double wavelength);

}  // namespace contrejour::inline internal::polynomial
