// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/budget/band_error.h"

#include <cmath>

namespace contrejour::inline internal::adaptive {
namespace {

// The squared difference between an edge one pixel wide and the same edge displaced by u pixels.
double edge_moved(double u) {
  u = std::abs(u);
  return u < 1.0 ? u * u * (1.0 - u / 3.0) : u - 1.0 / 3.0;
}

double dot(const Rgb& a, const Rgb& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

}  // namespace

// With r = edge_moved, and d_k the displacement of edge k from where it is drawn, the product of the errors of edges k
// and l is (r(d_k) + r(d_l) - r(d_k - d_l)) / 2, as for any variogram.
double band_error(std::span<const SpectralEdge> edges, double drawn_px) {
  Rgb light{}, off{};
  double separate = 0.0;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const SpectralEdge& edge = edges[k];
    const double moved = edge_moved(edge.position_px - drawn_px);
    for (std::size_t c = 0; c < light.size(); ++c) light[c] += edge.light[c], off[c] += edge.light[c] * moved;
    for (const SpectralEdge& before : edges.first(k))
      separate += dot(edge.light, before.light) * edge_moved(edge.position_px - before.position_px);
  }
  return (dot(light, off) - separate) / static_cast<double>(light.size());
}

double middle_of_light(std::span<const SpectralEdge> edges) {
  double light = 0.0, sum = 0.0;
  for (const SpectralEdge& edge : edges) {
    light += all_light(edge), sum += all_light(edge) * edge.position_px;
  }
  return light > 0.0 ? sum / light : edges[edges.size() / 2].position_px;
}

}  // namespace contrejour::inline internal::adaptive
