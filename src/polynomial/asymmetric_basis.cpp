// SPDX-License-Identifier: Apache-2.0
#include "polynomial/asymmetric_basis.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "polynomial/chebyshev_basis.h"
#include "polynomial/zone_rays.h"

namespace contrejour::inline internal::polynomial {
namespace {

constexpr std::size_t kAsymmetricPowers = static_cast<std::size_t>(kMaxAsymmetricDegree) + 1;
static_assert(kMaxAsymmetricDegree >= kCentreDegree);

Parity even_if(bool even) { return even ? Parity::Even : Parity::Any; }
Parity odd_if(bool even) { return even ? Parity::Odd : Parity::Any; }

}  // namespace

Parities parities_of_x(const AsymmetricZone& zone) { return {odd_if(zone.even_x), even_if(zone.even_y)}; }
Parities parities_of_y(const AsymmetricZone& zone) { return {even_if(zone.even_x), odd_if(zone.even_y)}; }
Parities parities_of_scalar(const AsymmetricZone& zone) { return {even_if(zone.even_x), even_if(zone.even_y)}; }

int asymmetric_term_count(int degree, const Parities& parities) {
  int count = 0;
  for_each_asymmetric_term(degree, parities, [&](int, int, int, int) { ++count; });
  return count;
}

Vec2 field_point(const AsymmetricZone& zone, Vec2 tangents) {
  const Vec2 twice = tangents * 2.0 - zone.low - zone.high, size = zone.high - zone.low;
  return {twice.x / size.x, twice.y / size.y};
}

Vec2 tangents_at(const AsymmetricZone& zone, Vec2 s) {
  return {std::lerp(zone.low.x, zone.high.x, 0.5 + 0.5 * s.x), std::lerp(zone.low.y, zone.high.y, 0.5 + 0.5 * s.y)};
}

std::array<double, 10> centre_terms(Vec2 s) {
  std::array<double, kCentreDegree + 1> x{}, y{};
  chebyshev_values(s.x, x);
  chebyshev_values(s.y, y);
  std::array<double, 10> terms{};
  std::size_t at = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    for (std::size_t j = 0; i + j < x.size(); ++j) terms[at++] = x[i] * y[j];
  return terms;
}

Vec2 centre_at(const AsymmetricZone& zone, Vec2 s) {
  const std::array<double, 10> terms = centre_terms(s);
  Vec2 centre;
  for (std::size_t k = 0; k < terms.size(); ++k)
    centre = centre + Vec2{zone.centre_x_mm[k], zone.centre_y_mm[k]} * terms[k];
  return centre;
}

AsymmetricPoint asymmetric_point(const AsymmetricZone& zone, Vec2 tangents, Vec2 entrance_mm) {
  const Vec2 s = field_point(zone, tangents);
  const Vec2 from = entrance_mm - centre_at(zone, s);
  return {{from.x / zone.radius_mm.x, from.y / zone.radius_mm.y}, s};
}

void asymmetric_term_values(int degree, const Parities& parities, const AsymmetricPoint& point, std::span<double> out) {
  std::array<double, kAsymmetricPowers> px{}, py{}, sx{}, sy{};
  chebyshev_values(point.p.x, px);
  chebyshev_values(point.p.y, py);
  chebyshev_values(point.s.x, sx);
  chebyshev_values(point.s.y, sy);
  std::size_t at = 0;
  for_each_asymmetric_term(degree, parities, [&](int a, int b, int c, int d) {
    out[at++] = px[static_cast<std::size_t>(a)] * py[static_cast<std::size_t>(b)] * sx[static_cast<std::size_t>(c)] *
                sy[static_cast<std::size_t>(d)];
  });
}

double value_of(const ChebyshevSum& sum, const Parities& parities, const AsymmetricPoint& point, double wavelength) {
  if (sum.degree < 0) return 0.0;
  std::vector<double> terms(static_cast<std::size_t>(asymmetric_term_count(sum.degree, parities)));
  asymmetric_term_values(sum.degree, parities, point, terms);
  return value_by_terms(sum, terms, wavelength);
}

AsymmetricBounds bounds_between(const AsymmetricZone& zone, Vec2 tangents) {
  const int cells = zone.bounds_side - 1;
  const Vec2 s = field_point(zone, tangents);
  const auto cell = [&](double coordinate) {
    return std::clamp(static_cast<int>(std::floor((0.5 + 0.5 * coordinate) * cells)), 0, cells - 1);
  };
  const int column = cell(s.x), row = cell(s.y);
  const Vec2 here = centre_at(zone, s);
  std::optional<Rectangle> hull;  // about the centre
  for (int iy = row; iy <= row + 1; ++iy) {
    for (int ix = column; ix <= column + 1; ++ix) {
      const AsymmetricBounds& b = zone.bounds[static_cast<std::size_t>(iy * zone.bounds_side + ix)];
      if (!lets_light_in(b)) continue;
      const Vec2 centre = centre_at(zone, {2.0 * ix / cells - 1.0, 2.0 * iy / cells - 1.0});
      const Rectangle about{Vec2{b.low_x_mm, b.low_y_mm} - centre, Vec2{b.high_x_mm, b.high_y_mm} - centre};
      hull = hull ? both(*hull, about) : about;
    }
  }
  if (!hull) return {};
  return {static_cast<float>(here.x + hull->low.x), static_cast<float>(here.y + hull->low.y),
          static_cast<float>(here.x + hull->high.x), static_cast<float>(here.y + hull->high.y)};
}

}  // namespace contrejour::inline internal::polynomial

namespace contrejour {

double area_of(const GhostPolynomials& ghost, const AsymmetricZone& zone) {
  const Vec2 size = zone.high - zone.low;
  const double images = (ghost.mirror_x && !zone.even_x ? 2.0 : 1.0) * (ghost.mirror_y && !zone.even_y ? 2.0 : 1.0);
  return images * size.x * size.y / std::numbers::pi;
}

FoundAsymmetricZone find_zone(const GhostPolynomials& ghost, Vec2 tangents) {
  for (const AsymmetricZone& zone : ghost.asymmetric) {
    FoundAsymmetricZone found{&zone, ghost.mirror_x && !zone.even_x && tangents.x < 0.0,
                              ghost.mirror_y && !zone.even_y && tangents.y < 0.0};
    const Vec2 at{found.mirrored_x ? -tangents.x : tangents.x, found.mirrored_y ? -tangents.y : tangents.y};
    if (at.x >= zone.low.x && at.x <= zone.high.x && at.y >= zone.low.y && at.y <= zone.high.y) return found;
  }
  return {};
}

std::optional<PolynomialRay> evaluate(const LensPolynomials& polynomials, const GhostPolynomials& ghost, Vec2 tangents,
                                      Vec2 entrance_mm, double lambda_nm) {
  using namespace polynomial;
  const FoundAsymmetricZone found = find_zone(ghost, tangents);
  if (found.zone == nullptr || found.zone->state != PolynomialZone::State::Fitted) return std::nullopt;
  const AsymmetricZone& zone = *found.zone;
  const auto mirrored = [&](Vec2 v) { return Vec2{found.mirrored_x ? -v.x : v.x, found.mirrored_y ? -v.y : v.y}; };
  const AsymmetricPoint point = asymmetric_point(zone, mirrored(tangents), mirrored(entrance_mm));
  const double wavelength = wavelength_coordinate(polynomials, lambda_nm);
  const auto vector_of = [&](const AsymmetricVector& vector) {
    return mirrored({value_of(vector.x, parities_of_x(zone), point, wavelength),
                     value_of(vector.y, parities_of_y(zone), point, wavelength)});
  };
  const auto scalar_of = [&](const ChebyshevSum& sum) {
    return value_of(sum, parities_of_scalar(zone), point, wavelength);
  };
  PolynomialRay ray;
  ray.sensor_mm = vector_of(zone.sensor_mm);
  for (std::size_t c = 0; c < zone.stop.size() && c < ray.stop.size(); ++c) ray.stop[c] = vector_of(zone.stop[c]);
  double squared = 0.0;
  for (const PolynomialRim& rim : zone.rims) squared = std::max(squared, scalar_of(rim.squared));
  ray.relative_height = std::sqrt(squared);
  ray.transmittance = scalar_of(zone.transmittance);
  return ray;
}

}  // namespace contrejour
