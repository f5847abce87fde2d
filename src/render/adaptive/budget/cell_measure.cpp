// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/budget/cell_measure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "render/adaptive/budget/frame_error.h"
#include "render/adaptive/budget/limit_error.h"
#include "render/adaptive/budget/visible_faults.h"
#include "render/adaptive/cells/cell_shape.h"

namespace contrejour::inline internal::adaptive {
namespace {

using NineVertices = std::array<std::size_t, 9>;

constexpr double kPixel = 1.0;      // area below which only a cell's flux is visible
constexpr double kFoldBound = 0.5;  // fraction of the largest possible error that a folded cell makes: found by
                                    // measuring what doubling it does to errors and to the number of cells
constexpr double kMostBend = 0.04;  // largest displacement of a clipping edge, over the cell's size

// The mean square residual of the best plane through a cell's nine vertices, row by row.
template <class ValueAt>
double off_plane(const ValueAt& at) {
  std::array<double, 9> e;
  for (std::size_t k = 0; k < 9; ++k) e[k] = at(k);
  const double mean = (e[0] + e[1] + e[2] + e[3] + e[4] + e[5] + e[6] + e[7] + e[8]) / 9.0;
  const double along_u = (e[2] + e[5] + e[8] - e[0] - e[3] - e[6]) / 6.0;
  const double along_v = (e[6] + e[7] + e[8] - e[0] - e[1] - e[2]) / 6.0;
  double sum = 0.0;
  for (std::size_t k = 0; k < 9; ++k) {
    const double plane =
        mean + along_u * (static_cast<double>(k % 3) - 1.0) + along_v * (static_cast<double>(k / 3) - 1.0);
    sum += (e[k] - plane) * (e[k] - plane) / 9.0;
  }
  return sum;
}

// Whether one plane for the cell shows as a facet.
bool is_facet(const BandContext& band, const Mesh& mesh, const Cell& cell, const CellMeasure& m) {
  if (m.on_plane || !(m.area_px > kFacet_px && m.mean * cell.pattern.most > kFacetLevel * band.peak)) return false;
  const NineVertices v = cell.vertices();
  double facet = mesh.layout.weights == 1 ? m.off_plane : 0.0;
  for (int c = 0; c < 3 && mesh.layout.weights == 3; ++c)
    facet += off_plane([&](std::size_t k) { return mesh.irradiance(c, v[k]); }) / 3.0;
  return facet > kFacet * kFacet * m.mean * m.mean;
}

// An upper bound of the squared error of any cell: its whole flux is displaced within its bounds, `extent`.
struct WorstError {
  double flux = 0.0, box = 0.0, squared = 0.0;

  WorstError(const Mesh& mesh, const Cell& cell, Vec2 extent)
      : flux(std::abs(mesh.brightness[cell.middle] * mesh.area[cell.middle]) * cell.size * cell.size),
        box(std::max(extent.x, kPixel) * std::max(extent.y, kPixel)) {
    // A shape smaller than a pixel that moves by a quarter of its size changes the pixels by an eighth of the squared
    // size.
    const double seen_part = dot(extent, extent) / (dot(extent, extent) + 8.0);
    squared = flux * flux / box * seen_part;
  }
};

// Integrates the area and the flux by Simpson's rule.
void integrate(const Mesh& mesh, const Cell& cell, CellMeasure& m) {
  const NineVertices v = cell.vertices();
  for (std::size_t k = 0; k < 9; ++k) {
    const double part = kSimpson[k % 3] * kSimpson[k / 3] * std::abs(mesh.area[v[k]]) * cell.size * cell.size;
    m.image_px += part;
    m.flux += part * static_cast<double>(mesh.brightness[v[k]]);
  }
}

}  // namespace

CellMeasure measure(const BandContext& band, const Mesh& mesh, const Cell& cell, bool on_plane) {
  const NineVertices v = cell.vertices();
  CellMeasure m;
  if (cell.pattern.most == 0.0) return m;
  Bounds b;
  bool folded = false;
  double sum = 0.0;
  for (const std::size_t k : v) {
    b.add(mesh.position(k));
    folded = folded || mesh.area[k] * mesh.area[cell.middle] <= 0.0F;
    sum += mesh.brightness[k];
  }
  m.mean = sum / 9.0;
  const WorstError worst(mesh, cell, b.size());
  if (folded) {
    const double seen = seen_share(worst.flux / worst.box, band.peak);
    m.whole = kFoldBound * worst.squared * seen * seen;
    return m;
  }
  m.on_plane = on_plane;
  if (!on_plane) m.off_plane = off_plane([&](std::size_t k) { return static_cast<double>(mesh.brightness[v[k]]); });
  const auto [lowest, highest] = std::ranges::minmax(v, {}, [&](std::size_t k) { return mesh.brightness[k]; });
  m.range = static_cast<double>(mesh.brightness[highest]) - mesh.brightness[lowest];
  m.area_px = std::abs(mesh.area[cell.middle]) * cell.size * cell.size;
  if (is_facet(band, mesh, cell, m)) {
    m.whole = std::numeric_limits<double>::infinity();
    return m;
  }
  if (cell.state == CellState::Cut) {
    m.limit = limit_error(band, mesh, cell);
    if (m.limit * cell.pattern.most > kMostBend) {
      m.whole = std::numeric_limits<double>::infinity();  // or light would be lost unnoticed
      return m;
    }
  }
  integrate(mesh, cell, m);
  m.longest_px = std::max(b.size().x, b.size().y);
  m.most = 4.0 * worst.squared;
  return m;
}

}  // namespace contrejour::inline internal::adaptive
