// SPDX-License-Identifier: Apache-2.0
// The rays that a zone is fitted to, and how much each of them counts.
#pragma once

#include <span>
#include <vector>

#include "polynomial/chebyshev_basis.h"
#include "polynomial/fit_zone.h"

namespace contrejour::inline internal::polynomial {

inline constexpr int kWavelengths = 13;  // of a fit, Chebyshev-Lobatto points

// Rays of a fit that arrive at all wavelengths and nodes, and how much each of them counts.
struct WeightedRays {
  std::vector<std::size_t> used;
  std::vector<double> weight;

  void add(std::size_t ray, double by) {
    used.push_back(ray);
    weight.push_back(by);
  }
};

// A fit's rays at one node, at all of its wavelengths.
struct NodeRays {
  std::vector<RayStart> starts;
  std::vector<RayTable> tables;  // one a wavelength

  [[nodiscard]] const RayTable& middle() const { return tables[tables.size() / 2]; }
  // The largest over the wavelengths.
  [[nodiscard]] double clearance(std::size_t ray) const {
    double largest = 0.0;
    for (const RayTable& table : tables) largest = std::max(largest, table.clearance(ray));
    return largest;
  }
};

// The rays of a fit: the same points of the zone at all nodes.
struct FitRays {
  std::vector<NodeRays> nodes;
  std::vector<ZonePoint> points, light_points;  // of edges; of positions on the sensor and transmittances
  WeightedRays for_sensor, for_light, for_edges;  // positions on the sensor; transmittances; the stop and rims
};

// zones: with their bounds and pupil coordinates, one a node. Sets the end of their pupils.
[[nodiscard]] FitRays fit_rays(const ZoneProblem& problem, std::span<PolynomialZone> zones);

// Sets the weights of all rays from the nodes. near_mm: rays that land farther from the sensor's middle count less.
void weigh_rays(FitRays& rays, double near_mm);

// Adds the steps whose rims block light that nothing else blocks: the one that blocks most comes first. table: at the
// middle wavelength.
void add_blocking_steps(const RayTable& table, std::vector<int>& steps);

// The mean over the zone's area of the ghost's flux.
[[nodiscard]] double flux_mm2(const PolynomialZone& zone, const NodeRays& rays);

}  // namespace contrejour::inline internal::polynomial
