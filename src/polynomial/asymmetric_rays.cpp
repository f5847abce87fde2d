// SPDX-License-Identifier: Apache-2.0
#include "polynomial/asymmetric_rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "polynomial/least_squares.h"
#include "polynomial/left_out_rays.h"
#include "polynomial/zone_nodes.h"

namespace contrejour::inline internal::polynomial {
namespace {

constexpr double kRoomAround = 1.02;  // of the pupil radii, around the bounds
constexpr double kCentreRidge = 1e-4;
constexpr int kBoundsSide = 7;
constexpr int kRaysAtDirection = 40, kTriedAtDirection = 100;
// Rays that are farther outside the light than this count little, so that few of those tried are kept.
constexpr double kNearLight = 1.2;
constexpr int kKeptOfFar = 4;  // every one of as many
// Multiples of the powers of the inverse of the plastic number: Roberts' R2 sequence.
constexpr double kStepFirst = 0.7548776662466927, kStepSecond = 0.5698402909980532;

double cosine_spaced_within(double t) { return -std::cos(std::numbers::pi * t); }
double density_within(double t) { return 0.5 * std::numbers::pi * std::sin(std::numbers::pi * t); }

Vec2 sequence_point(std::size_t index) {
  return {std::fmod(0.5 + kStepFirst * static_cast<double>(index), 1.0),
          std::fmod(0.5 + kStepSecond * static_cast<double>(index), 1.0)};
}

// A sequence's coordinate for one axis of the field: the upper half of it in an even zone.
double within_side(double t, bool even) { return even ? 0.5 + 0.5 * t : t; }

Vec2 node_of(const AsymmetricZone& zone, std::size_t k) {
  const auto side = static_cast<std::size_t>(zone.bounds_side);
  const double cells = zone.bounds_side - 1;
  return {2.0 * static_cast<double>(k % side) / cells - 1.0, 2.0 * static_cast<double>(k / side) / cells - 1.0};
}

// The centre's coefficients along one axis, of the middles of all bounds with light. Terms that have not the parity of
// the vectors' coordinate are 0.
std::array<double, 10> centre_of(const AsymmetricZone& zone, const Parities& parities, bool along_y) {
  std::array<bool, 10> used{};
  std::size_t count = 0, at = 0;
  for (int i = 0; i <= kCentreDegree; ++i)
    for (int j = 0; i + j <= kCentreDegree; ++j, ++at)
      if (has_parity(parities.x, i) && has_parity(parities.y, j)) used[at] = true, ++count;
  Rows rows{count, {}};
  std::vector<double> right;
  for (std::size_t k = 0; k < zone.bounds.size(); ++k) {
    const AsymmetricBounds& b = zone.bounds[k];
    if (!lets_light_in(b)) continue;
    const std::array<double, 10> terms = centre_terms(node_of(zone, k));
    for (std::size_t t = 0; t < terms.size(); ++t)
      if (used[t]) rows.values.push_back(terms[t]);
    right.push_back(along_y ? 0.5 * (static_cast<double>(b.low_y_mm) + b.high_y_mm)
                            : 0.5 * (static_cast<double>(b.low_x_mm) + b.high_x_mm));
  }
  const std::vector<double> solution = LeastSquares(rows, kCentreRidge).solve(right);
  std::array<double, 10> centre{};
  std::size_t next = 0;
  for (std::size_t t = 0; t < centre.size(); ++t)
    if (used[t]) centre[t] = solution[next++];
  return centre;
}

// Rays in and around the light, as one wavelength shows it. `area_mm2` of those near it is that of the whole sample.
std::vector<RayStart> starts_near_light(const AsymmetricProblem& problem, const AsymmetricZone& zone, int fields) {
  const std::vector<RayStart> tried = starts_within(zone, {fields, kTriedAtDirection, 1, 1});
  const RayTable table = problem.rays.trace(tried, wavelength_at(problem.lens, 0.0));
  std::vector<RayStart> kept;
  int near = 0, far = 0;
  for (std::size_t k = 0; k < tried.size(); ++k) {
    const bool first = k == 0 || tried[k].field != tried[k - 1].field || tried[k].field_y != tried[k - 1].field_y;
    if (first) near = 0;
    const bool is_near = table.clearance(k) < kNearLight;
    if (is_near ? near++ < kRaysAtDirection : far++ % kKeptOfFar == 0) kept.push_back(tried[k]);
  }
  return kept;
}

AsymmetricBounds mirrored_bounds(const AsymmetricBounds& b, bool in_x, bool in_y) {
  AsymmetricBounds out = b;
  if (in_x) out.low_x_mm = -b.high_x_mm, out.high_x_mm = -b.low_x_mm;
  if (in_y) out.low_y_mm = -b.high_y_mm, out.high_y_mm = -b.low_y_mm;
  return out;
}

}  // namespace

void set_pupil_coordinates(AsymmetricZone& zone) {
  zone.centre_x_mm = centre_of(zone, parities_of_x(zone), false);
  zone.centre_y_mm = centre_of(zone, parities_of_y(zone), true);
  Vec2 farthest;
  for (std::size_t k = 0; k < zone.bounds.size(); ++k) {
    const AsymmetricBounds& b = zone.bounds[k];
    if (!lets_light_in(b)) continue;
    const Vec2 centre = centre_at(zone, node_of(zone, k));
    farthest.x = std::max({farthest.x, b.high_x_mm - centre.x, centre.x - b.low_x_mm});
    farthest.y = std::max({farthest.y, b.high_y_mm - centre.y, centre.y - b.low_y_mm});
  }
  zone.radius_mm = farthest * kRoomAround;
}

std::vector<RayStart> starts_within(const AsymmetricZone& zone, const AsymmetricSampling& sampling) {
  std::vector<RayStart> starts;
  std::size_t index = sampling.first;
  for (int f = 0; f < sampling.fields; ++f) {
    const Vec2 t = sequence_point(sampling.field_index + static_cast<std::size_t>(f));
    const Vec2 tangents = tangents_at(zone, {cosine_spaced_within(within_side(t.x, zone.even_x)),
                                             cosine_spaced_within(within_side(t.y, zone.even_y))});
    const AsymmetricBounds b = bounds_between(zone, tangents);
    if (!lets_light_in(b)) continue;
    const double width = static_cast<double>(b.high_x_mm) - b.low_x_mm;
    const double height = static_cast<double>(b.high_y_mm) - b.low_y_mm;
    for (int k = 0; k < sampling.count; ++k, ++index) {
      const Vec2 at = sequence_point(index);
      starts.push_back({tangents.x,
                        {b.low_x_mm + width * 0.5 * (1.0 + cosine_spaced_within(at.x)),
                         b.low_y_mm + height * 0.5 * (1.0 + cosine_spaced_within(at.y))},
                        density_within(at.x) * width * density_within(at.y) * height / sampling.count,
                        tangents.y});
    }
  }
  return starts;
}

FitRays fit_rays(const AsymmetricProblem& problem, const AsymmetricZone& zone, int fields) {
  FitRays rays;
  NodeRays& node = rays.nodes.emplace_back();
  node.starts = starts_near_light(problem, zone, fields);
  for (int k = 0; k < kWavelengths; ++k)
    node.tables.push_back(
        problem.rays.trace(node.starts, wavelength_at(problem.lens, node_coordinate(k, kWavelengths))));
  weigh_rays(rays, kNearSensor * length(problem.sensor_half_mm));
  return rays;
}

AsymmetricZone with_bounds(const AsymmetricProblem& problem, const AsymmetricZone& place) {
  AsymmetricZone zone = place;
  zone.bounds_side = kBoundsSide;
  zone.bounds.assign(std::size_t{kBoundsSide} * kBoundsSide, {});
  const int cells = kBoundsSide - 1;
  std::optional<Rectangle> near;
  for (int iy = zone.even_y ? cells / 2 : 0; iy <= cells; ++iy) {
    for (int ix = zone.even_x ? cells / 2 : 0; ix <= cells; ++ix) {
      const Vec2 tangents = tangents_at(zone, {2.0 * ix / cells - 1.0, 2.0 * iy / cells - 1.0});
      const AsymmetricBounds b = problem.rays.bounds(tangents, near, false);
      if (lets_light_in(b)) {
        const Vec2 low{b.low_x_mm, b.low_y_mm}, high{b.high_x_mm, b.high_y_mm}, more = (high - low) * 0.4;
        near = Rectangle{low - more, high + more};
      }
      for (const bool in_x : {false, true})
        for (const bool in_y : {false, true}) {
          if ((in_x && !zone.even_x) || (in_y && !zone.even_y)) continue;
          const int at_x = in_x ? cells - ix : ix, at_y = in_y ? cells - iy : iy;
          zone.bounds[static_cast<std::size_t>(at_y * kBoundsSide + at_x)] = mirrored_bounds(b, in_x, in_y);
        }
    }
  }
  return zone;
}

double flux_mm2(const AsymmetricZone& zone, const NodeRays& rays, int fields) {
  constexpr double kMeanWeight = 4.0 / (std::numbers::pi * std::numbers::pi);
  const RayTable& middle = rays.middle();
  // Directions are denser towards the zone's border, by the arcsine's density.
  const auto weight_at = [&](const RayStart& start) {
    const Vec2 s = field_point(zone, {start.field, start.field_y});
    return std::sqrt(std::max(0.0, (1.0 - s.x * s.x) * (1.0 - s.y * s.y)));
  };
  double sum = 0.0;
  for (std::size_t k = 0; k < rays.starts.size(); ++k) {
    const RayStart& start = rays.starts[k];
    if (middle.clearance(k) > 1.0) continue;
    sum += weight_at(start) * start.area_mm2 * middle.transmission[k] /
           std::sqrt(1.0 + start.field * start.field + start.field_y * start.field_y);
  }
  return sum / (kMeanWeight * fields);
}

}  // namespace contrejour::inline internal::polynomial
