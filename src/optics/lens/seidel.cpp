// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/seidel.h"

#include <cmath>

#include "contrejour/expert/check_lens.h"
#include "contrejour/expert/first_order.h"

namespace contrejour {
namespace {

struct ParaxialRay {
  double y_mm = 0, u = 0;
};

// 8 times the coefficient of r^4 by which a surface departs from the sphere of its vertex curvature.
double departure_per_mm3(const SurfaceState& s, double vertex_curvature_per_mm) {
  const double c = s.curvature_per_mm, v = vertex_curvature_per_mm;
  const double a4 = s.shape.powers.size() >= 4 ? s.shape.powers[3] : 0.0;
  return (1.0 + s.shape.conic) * c * c * c - v * v * v + 8.0 * a4;
}

// Refractive indices on both sides, and their difference between the outer wavelengths.
struct Media {
  double n, n_after, dn, dn_after;
};

Media media_at(const SurfaceState& s, const SeidelRequest& request) {
  const auto dispersion = [&](const Glass& glass) {
    return refractive_index(glass, request.short_nm) - refractive_index(glass, request.long_nm);
  };
  return {refractive_index(s.before, request.lambda_nm), refractive_index(s.after, request.lambda_nm),
          dispersion(s.before), dispersion(s.after)};
}

// Welford 8.5 (spheres), 8.7 (aspheres), 10.5 (colour); distortion in the form without 1 / A.
SeidelSums sums_at(const SurfaceState& s, const Media& m, const ParaxialRay& marginal, const ParaxialRay& chief,
                   double u_after) {
  const double c = vertex_curvature(s.curvature_per_mm, s.shape, Section::Y);
  const double y = marginal.y_mm, y_bar = chief.y_mm;
  const double a = m.n * (marginal.u + y * c);
  const double a_bar = m.n * (chief.u + y_bar * c);
  const double lagrange = m.n * (chief.u * y - marginal.u * y_bar);
  const double d_u_over_n = u_after / m.n_after - marginal.u / m.n;
  const double d_1_over_n = 1.0 / m.n_after - 1.0 / m.n;
  const double d_1_over_n2 = 1.0 / (m.n_after * m.n_after) - 1.0 / (m.n * m.n);
  SeidelSums sums;
  sums.spherical = -a * a * y * d_u_over_n;
  sums.coma = -a * a_bar * y * d_u_over_n;
  sums.astigmatism = -a_bar * a_bar * y * d_u_over_n;
  sums.petzval = -lagrange * lagrange * c * d_1_over_n;
  sums.distortion = -a_bar * (a_bar * a_bar * d_1_over_n2 * y - (lagrange + a_bar * y) * y_bar * c * d_1_over_n);
  const double d_dn_over_n = m.dn_after / m.n_after - m.dn / m.n;
  sums.axial_colour = a * y * d_dn_over_n;
  sums.lateral_colour = a_bar * y * d_dn_over_n;

  const double bent = departure_per_mm3(s, c) * (m.n_after - m.n);
  sums.spherical += bent * y * y * y * y;
  sums.coma += bent * y * y * y * y_bar;
  sums.astigmatism += bent * y * y * y_bar * y_bar;
  sums.distortion += bent * y * y_bar * y_bar * y_bar;
  return sums;
}

ParaxialRay refracted(const ParaxialRay& ray, double curvature_per_mm, const Media& m) {
  return {ray.y_mm, (m.n * ray.u - ray.y_mm * curvature_per_mm * (m.n_after - m.n)) / m.n_after};
}

}  // namespace

SeidelSums& SeidelSums::operator+=(const SeidelSums& other) {
  spherical += other.spherical;
  coma += other.coma;
  astigmatism += other.astigmatism;
  petzval += other.petzval;
  distortion += other.distortion;
  axial_colour += other.axial_colour;
  lateral_colour += other.lateral_colour;
  return *this;
}

std::vector<SeidelSums> seidel_by_surface(const LensState& lens, const SeidelRequest& request) {
  if (!has_stop(lens)) return {};
  const FirstOrder figures = first_order(lens, request.lambda_nm);
  const double slope = std::tan(request.half_field_rad);
  ParaxialRay marginal{0.5 * figures.entrance_pupil_diameter_mm, 0.0};
  ParaxialRay chief{-slope * figures.entrance_pupil_position_mm, slope};
  std::vector<SeidelSums> sums;
  for (std::size_t k = 0; k < lens.surfaces.size(); ++k) {
    const SurfaceState& s = lens.surfaces[k];
    if (k > 0) {
      const double gap_mm = s.z_mm - lens.surfaces[k - 1].z_mm;
      marginal.y_mm += gap_mm * marginal.u;
      chief.y_mm += gap_mm * chief.u;
    }
    if (s.kind != SurfaceKind::Refracting) {
      sums.emplace_back();
      continue;
    }
    const Media media = media_at(s, request);
    const double c = vertex_curvature(s.curvature_per_mm, s.shape, Section::Y);
    const ParaxialRay after = refracted(marginal, c, media);
    sums.push_back(sums_at(s, media, marginal, chief, after.u));
    marginal = after;
    chief = refracted(chief, c, media);
  }
  return sums;
}

SeidelSums seidel_sums(const LensState& lens, const SeidelRequest& request) {
  SeidelSums total;
  for (const SeidelSums& sums : seidel_by_surface(lens, request)) total += sums;
  return total;
}

}  // namespace contrejour
