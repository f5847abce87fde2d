// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/emit/cell_light.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal::adaptive {
namespace {

// One of the weights, without gain: its mean, and its rise along the diagonals over the mean.
struct CellLevel {
  double weight = 0.0, along_d = 0.0, along_f = 0.0;
};

CellLevel cell_level(const Mesh& mesh, const Cell& cell, int weight) {
  const Mesh::Field& w = mesh.field(mesh.layout.weight(weight));
  CellLevel level;
  level.weight = 0.25 * (w[cell.corner[0]] + w[cell.corner[1]] + w[cell.corner[2]] + w[cell.corner[3]]);
  if (cell.size > 1) {  // Simpson's rule in both directions
    const double middles = 0.25 * (w[cell.side[0]] + w[cell.side[1]] + w[cell.side[2]] + w[cell.side[3]]);
    level.weight = (level.weight + 4.0 * middles + 4.0 * w[cell.middle]) / 9.0;
  }
  std::array<double, 4> e{};
  double mean = 0.0;
  double largest = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    e[k] = mesh.irradiance(weight, cell.corner[k]);
    mean += 0.25 * e[k];
    largest = std::max(largest, std::abs(e[k]));
  }
  // If the irradiance rises steeply, a plane through the corners would go below zero: it is then taken as constant.
  if (!(std::abs(mean) > 0.0) || largest > 2.0 * std::abs(mean)) return level;
  level.along_d = (e[2] - e[0]) / mean;
  level.along_f = (e[3] - e[1]) / mean;
  return level;
}

// The rise of the first weight stands for all, since weights of the channels are alike.
Vec2 weight_rise(const Mesh& mesh, const Cell& cell) {
  const Mesh::Field& w = mesh.field(mesh.layout.weight(0));
  const std::array<double, 4> at{w[cell.corner[0]], w[cell.corner[1]], w[cell.corner[2]], w[cell.corner[3]]};
  const double sum = at[0] + at[1] + at[2] + at[3];
  if (!(sum > 0.0)) return {};
  return Vec2{at[1] + at[2] - at[0] - at[3], at[2] + at[3] - at[0] - at[1]} * (2.0 / sum);
}

}  // namespace

void CellLight::dim(const Flux& by) {
  for (std::size_t c = 0; c < 3; ++c) {
    const auto times = static_cast<float>(by[c]);
    irradiance.value[c] *= times;
    irradiance.along_x[c] *= times;
    irradiance.along_y[c] *= times;
    flux[c] *= by[c];
  }
}

Flux flux_of(const Mesh& mesh, const Cell& cell) {
  Flux flux{};
  for (std::size_t c = 0; c < 3; ++c) {
    const int weight = static_cast<int>(c) < mesh.layout.weights ? static_cast<int>(c) : 0;
    flux[c] = mesh.gain[c] * cell_level(mesh, cell, weight).weight * mesh.cell_flux_area_mm2 * cell.size * cell.size;
  }
  return flux;
}

CellLight light_of(const Mesh& mesh, const Cell& cell, const DrawnShape& shape) {
  CellLight light;
  LinearIrradiance& irradiance = light.irradiance;
  const Vec2 middle = shape.centroid + mesh.origin_px, d = shape.diagonal, f = shape.other_diagonal;
  irradiance.at = {static_cast<float>(middle.x), static_cast<float>(middle.y)};
  const double flux_area = mesh.cell_flux_area_mm2 * cell.size * cell.size;
  // Pixels take the irradiance at their centres, which may lie well outside a cell smaller than a pixel.
  const double width = std::abs(shape.signed_px) / shape.longest_px();
  const double sloped = std::clamp(width - 1.0, 0.0, 1.0);
  light.slope = weight_rise(mesh, cell);
  CellLevel level;
  for (std::size_t c = 0; c < 3; ++c) {
    if (static_cast<int>(c) < mesh.layout.weights) level = cell_level(mesh, cell, static_cast<int>(c));
    const double gain = mesh.gain[c], value = gain * level.weight * flux_area / std::abs(shape.signed_px);
    const double scale = sloped * value / cross(d, f);
    light.flux[c] = gain * level.weight * flux_area;
    irradiance.value[c] = static_cast<float>(value);
    irradiance.along_x[c] = static_cast<float>((level.along_d * f.y - level.along_f * d.y) * scale);
    irradiance.along_y[c] = static_cast<float>((level.along_f * d.x - level.along_d * f.x) * scale);
  }
  return light;
}

CellLight light_of(const Mesh& mesh, const Cell& cell, const std::array<std::size_t, 3>& t) {
  const double flux_area = 0.5 * mesh.cell_flux_area_mm2 * cell.size * cell.size;
  const std::array<Vec2, 3> p{mesh.position(t[0]), mesh.position(t[1]), mesh.position(t[2])};
  const double area = 0.5 * std::abs(cross(p[1] - p[0], p[2] - p[0]));
  const Vec2 middle = (p[0] + p[1] + p[2]) * (1.0 / 3.0) + mesh.origin_px;
  CellLight light{.triangle = true};
  light.irradiance.at = {static_cast<float>(middle.x), static_cast<float>(middle.y)};
  for (std::size_t c = 0; c < 3; ++c) {
    const Mesh::Field& w = mesh.field(mesh.layout.weight_of(static_cast<int>(c)));
    light.flux[c] = mesh.gain[c] * (w[t[0]] + w[t[1]] + w[t[2]]) / 3.0 * flux_area;
    light.irradiance.value[c] = static_cast<float>(light.flux[c] / std::max(area, 1e-12));
  }
  return light;
}

}  // namespace contrejour::inline internal::adaptive
