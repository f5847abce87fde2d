// SPDX-License-Identifier: Apache-2.0
#include "polynomial/fit_rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "polynomial/left_out_rays.h"
#include "polynomial/zone_nodes.h"

namespace contrejour::inline internal::polynomial {
namespace {

constexpr int kRaysAtField = 96;
constexpr double kPastLight = 1.02;  // the end of a zone's pupil, over the largest |p| of rays for the sensor
// Relative heights beyond which rays are left out, and how steeply rays that are blocked count less before. Next to the
// light, a ghost's rays often are close to total reflection or to missing a surface, where its map has a branch point:
// a polynomial that follows these rays spends its degrees there. Positions on the sensor and transmittances matter only
// for light that gets through; the edges that block light must also block all light beyond.
constexpr double kFarthestLight = 1.2, kFarthestEdge = 2.0;
constexpr double kFallLight = 48.0, kFallEdge = 48.0;
// How steeply rays count less the farther from the sensor they land. Those far out are rays of steep directions, where
// positions vary most, and matter for no picture: where they count in proportion to the inverse of the distance, they
// have most of the squared error. Transmittances vary less, and remain near their values there.
constexpr double kFallLanding = 12.0, kFallLandingOfLight = 6.0;
constexpr std::size_t kFewLanding = 40;  // rays of a fit near the sensor, below which all of its rays are tested
constexpr double kFallElsewhere = 6.0;  // of rays that get through at one node of a range, and far from it at another
// Squared relative heights next to an edge, wide enough that the few rays there show which rim is the outermost, and by
// how much a rim must exceed the others.
constexpr double kOpenLimit = 1.12, kBlockingRim = 0.88, kOutermostBy = 0.004;

}  // namespace

// A ray counts as at the node at which most of it gets through: between the nodes, light may be wherever it is at one
// of them. A ray that fails at any node is left out.
void weigh_rays(FitRays& rays, double near_mm) {
  std::vector<double> by_landing;  // of the rays for the sensor
  std::size_t landing = 0;
  for (std::size_t ray = 0; ray < rays.nodes.front().starts.size(); ++ray) {
    double clearance = kFailed, largest = 0.0, landing_mm = kFailed;
    for (const NodeRays& node : rays.nodes) {
      const double here = node.clearance(ray);
      clearance = std::min(clearance, here);
      largest = std::max(largest, here);
      landing_mm =
          std::min<double>(landing_mm, std::hypot(node.middle().sensor_x_mm[ray], node.middle().sensor_y_mm[ray]));
    }
    if (!(largest < kFailed)) continue;
    // For a single node the two clearances are equal.
    const double elsewhere = rays.nodes.size() > 1 ? std::pow(std::max(largest, 1.0), -kFallElsewhere) : 1.0;
    const auto falling = [&](double power) { return elsewhere * std::pow(std::max(clearance, 1.0), -power); };
    if (clearance < kFarthestLight) {
      by_landing.push_back(std::min(1.0, near_mm / std::max(landing_mm, near_mm)));
      rays.for_sensor.add(ray, falling(kFallLight));
      rays.for_light.add(ray, falling(kFallLight));
      if (clearance <= 1.0 && landing_mm <= near_mm) ++landing;
    }
    if (clearance < kFarthestEdge) rays.for_edges.add(ray, falling(kFallEdge));
  }
  const bool few = landing < kFewLanding;
  for (std::size_t k = 0; k < by_landing.size(); ++k) {
    rays.for_sensor.weight[k] *= std::pow(by_landing[k], few ? 1.0 : kFallLanding);
    rays.for_light.weight[k] *= std::pow(by_landing[k], few ? 1.0 : kFallLandingOfLight);
  }
}

FitRays fit_rays(const ZoneProblem& problem, std::span<PolynomialZone> zones) {
  FitRays out;
  for (std::size_t n = 0; n < zones.size(); ++n) {
    NodeRays& node = out.nodes.emplace_back();
    node.starts = starts_within(zones[n].bounds, kRaysAtField, 1);
    for (int k = 0; k < kWavelengths; ++k)
      node.tables.push_back(
          problem.nodes[n].rays->trace(node.starts, wavelength_at(problem.lens, node_coordinate(k, kWavelengths))));
  }
  weigh_rays(out, kNearSensor * length(problem.sensor_half_mm));
  const auto point_of = [&](std::size_t ray) {
    const RayStart& start = out.nodes.front().starts[ray];
    return zone_point(zones.front(), start.field, start.entrance_mm);
  };
  double farthest = 0.0;
  for (const std::size_t ray : out.for_sensor.used) farthest = std::max(farthest, length(point_of(ray).p));
  for (PolynomialZone& zone : zones) zone.pupil_end = kPastLight * farthest;
  for (std::size_t ray = 0; ray < out.nodes.front().starts.size(); ++ray) {
    out.points.push_back(point_of(ray));
    out.light_points.push_back(out.points.back().of_light());
  }
  return out;
}

void add_blocking_steps(const RayTable& table, std::vector<int>& steps) {
  std::vector<std::size_t> used;
  std::vector<double> limits;  // squared, of the stop and of the steps found so far
  for (std::size_t k = 0; k < table.size(); ++k) {
    if (!(table.clearance(k) < kFarthestEdge)) continue;
    used.push_back(k);
    limits.push_back(0.0);
    for (const auto& crossing : table.stop)
      limits.back() = std::max(limits.back(), std::pow(std::hypot(crossing[0][k], crossing[1][k]), 2.0));
  }
  const auto include = [&](int step) {
    for (std::size_t k = 0; k < limits.size(); ++k)
      limits[k] = std::max(limits[k], static_cast<double>(table.rim_squared[static_cast<std::size_t>(step)][used[k]]));
  };
  for (const int step : steps) include(step);
  for (;;) {
    int most = 0, found = -1;
    for (std::size_t step = 0; step < table.rim_squared.size(); ++step) {
      int count = 0;
      for (std::size_t k = 0; k < limits.size(); ++k) {
        const double height = table.rim_squared[step][used[k]];
        count += limits[k] < kOpenLimit && height > std::max(kBlockingRim, limits[k] + kOutermostBy) ? 1 : 0;
      }
      if (count > most && std::ranges::find(steps, static_cast<int>(step)) == steps.end())
        most = count, found = static_cast<int>(step);
    }
    if (found < 0) return;
    steps.push_back(found);
    include(found);
  }
}

double flux_mm2(const PolynomialZone& zone, const NodeRays& rays) {
  const RayTable& middle = rays.middle();
  double sum = 0.0, weights = 0.0;
  for (std::size_t f = 0; f < zone.bounds.size(); ++f) {
    const double field = zone.bounds[f].field;
    const double weight = std::sin(std::numbers::pi * (static_cast<double>(f) + 0.5) /
                                   static_cast<double>(zone.bounds.size()));  // Lobatto points are denser at both ends
    weights += weight;
    for (std::size_t k = 0; k < rays.starts.size(); ++k)
      if (rays.starts[k].field == field && middle.clearance(k) <= 1.0)
        sum += weight * rays.starts[k].area_mm2 * middle.transmission[k] / std::sqrt(1.0 + field * field);
  }
  return sum / weights;
}

}  // namespace contrejour::inline internal::polynomial
