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
constexpr double kMaxNonlinearity = 0.04;  // largest displacement of a clipping edge, over the cell's size

// The mean square residual of the best plane through a cell's nine vertices, row by row.
template <class ValueAt>
double plane_residual(const ValueAt& at) {
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

// Returns whether one plane for the cell is visible as a facet.
bool is_facet(const BandContext& band, const Mesh& mesh, const Cell& cell, const CellMeasure& m) {
  if (m.uses_common_plane ||
      !(m.area_px > kFacet_px && m.mean * cell.pattern.max_transmittance > kFacetLevel * band.peak))
    return false;
  const NineVertices v = cell.vertices();
  double facet = mesh.layout.weights == 1 ? m.plane_residual : 0.0;
  for (int c = 0; c < 3 && mesh.layout.weights == 3; ++c)
    facet += plane_residual([&](std::size_t k) { return mesh.irradiance(c, v[k]); }) / 3.0;
  return facet > kFacet * kFacet * m.mean * m.mean;
}

// An upper bound of the squared error of any cell: its whole flux is displaced within its bounds, `extent`.
struct WorstError {
  double flux = 0.0, box = 0.0, squared = 0.0;

  WorstError(const Mesh& mesh, const Cell& cell, Vec2 extent)
      : flux(std::abs(mesh.rms_irradiance[cell.middle] * mesh.area[cell.middle]) * cell.size * cell.size),
        box(std::max(extent.x, kPixel) * std::max(extent.y, kPixel)) {
    // A shape smaller than a pixel that moves by a quarter of its size changes the pixels by an eighth of the squared
    // size.
    const double visible_part = dot(extent, extent) / (dot(extent, extent) + 8.0);
    squared = flux * flux / box * visible_part;
  }
};

// Integrates the area and the flux by Simpson's rule.
void integrate(const Mesh& mesh, const Cell& cell, CellMeasure& m) {
  const NineVertices v = cell.vertices();
  for (std::size_t k = 0; k < 9; ++k) {
    const double part = kSimpson[k % 3] * kSimpson[k / 3] * std::abs(mesh.area[v[k]]) * cell.size * cell.size;
    m.image_px += part;
    m.flux += part * static_cast<double>(mesh.rms_irradiance[v[k]]);
  }
}

}  // namespace

CellMeasure measure(const BandContext& band, const Mesh& mesh, const Cell& cell, bool uses_common_plane) {
  const NineVertices v = cell.vertices();
  CellMeasure m;
  if (cell.pattern.max_transmittance == 0.0) return m;
  Bounds b;
  bool folded = false;
  double sum = 0.0;
  for (const std::size_t k : v) {
    b.add(mesh.position(k));
    folded = folded || mesh.area[k] * mesh.area[cell.middle] <= 0.0F;
    sum += mesh.rms_irradiance[k];
  }
  m.mean = sum / 9.0;
  const WorstError worst(mesh, cell, b.size());
  if (folded) {
    const double visible = peak_limited_weight(worst.flux / worst.box, band.peak);
    m.total = kFoldBound * worst.squared * visible * visible;
    return m;
  }
  m.uses_common_plane = uses_common_plane;
  if (!uses_common_plane)
    m.plane_residual = plane_residual([&](std::size_t k) { return static_cast<double>(mesh.rms_irradiance[v[k]]); });
  const auto [lowest, highest] = std::ranges::minmax(v, {}, [&](std::size_t k) { return mesh.rms_irradiance[k]; });
  m.range = static_cast<double>(mesh.rms_irradiance[highest]) - mesh.rms_irradiance[lowest];
  m.area_px = std::abs(mesh.area[cell.middle]) * cell.size * cell.size;
  if (is_facet(band, mesh, cell, m)) {
    m.total = std::numeric_limits<double>::infinity();
    return m;
  }
  if (cell.state == CellState::Clipped) {
    m.limit = limit_error(band, mesh, cell);
    if (m.limit * cell.pattern.max_transmittance > kMaxNonlinearity) {
      m.total = std::numeric_limits<double>::infinity();  // or light would be lost unnoticed
      return m;
    }
  }
  integrate(mesh, cell, m);
  m.longest_px = std::max(b.size().x, b.size().y);
  m.max_error = 4.0 * worst.squared;
  return m;
}

}  // namespace contrejour::inline internal::adaptive
