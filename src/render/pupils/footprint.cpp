// SPDX-License-Identifier: Apache-2.0
#include "render/pupils/footprint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "render/pupils/open_halves.h"
#include "render/pupils/triangle_window.h"

namespace contrejour::inline internal::pupils {
namespace {

constexpr std::array<std::array<std::size_t, 3>, 2> kHalves{{{0, 1, 2}, {0, 2, 3}}};

// A cell that transmits light: its vertices in order, and the open fraction of each of the triangles 0, 1, 2 and 0, 2,
// 3.
struct OpenCell {
  std::array<std::size_t, 4> vertex;
  std::array<double, 2> open;
};

// Visits the cells of which all rays arrive.
template <class Visit>
void for_each_open_cell(const OpenMesh& mesh, const Visit& visit) {
  for (const Block& block : mesh.blocks) {
    for (const auto& v : kCellsOfBlock) {
      OpenCell cell{{block.vertex[v[0]], block.vertex[v[1]], block.vertex[v[2]], block.vertex[v[3]]}, {1.0, 1.0}};
      const auto blocked = [&](std::size_t k) { return mesh.blocked[cell.vertex[k]]; };
      const float a = blocked(0), b = blocked(1), c = blocked(2), d = blocked(3);
      const float highest = std::max(std::max(a, b), std::max(c, d));
      if (std::min(std::min(a, b), std::min(c, d)) > 0.0F || highest == std::numeric_limits<float>::infinity())
        continue;
      if (highest > 0.0F) cell.open = {fraction_below_zero(a, b, c), fraction_below_zero(a, c, d)};
      visit(cell);
    }
  }
}

// Area on the entrance plane (mm^2) times transmittance, of one of a cell's halves.
double light_of(const OpenMesh& mesh, const OpenCell& cell, std::size_t half) {
  double sum = 0.0;
  for (const std::size_t corner : kHalves[half]) sum += mesh.transmission[cell.vertex[corner]];
  return cell.open[half] * 0.5 * mesh.cell_mm2() * sum / 3.0;
}

double light_of(const OpenMesh& mesh, const OpenCell& cell) {
  return light_of(mesh, cell, 0) + light_of(mesh, cell, 1);
}

// Approximate mean irradiance of a cell's light over a square of a pixel's size, or over its image if that is larger.
double level_of(const OpenMesh& mesh, const OpenCell& cell, double pixel_mm) {
  const auto at = [&](std::size_t corner) { return mesh.sensor_point_mm(cell.vertex[corner]); };
  const Vec2 first = at(2) - at(0), second = at(3) - at(1);
  const double image_mm2 = 0.5 * std::abs(cross(first, second)) * 0.5 * (cell.open[0] + cell.open[1]);
  const double long_mm = std::max({length(first), length(second), pixel_mm});
  return light_of(mesh, cell) / (long_mm * std::max(image_mm2 / long_mm, pixel_mm));
}

constexpr double kMin_mm = 1e-9, kMax_mm = 1e9;  // of a square

// Candidates for the peak: the brightest cell, and points where many parts of the pupil overlap, by a hash table of
// squares of the sensor. (A hash collision only adds a candidate that is no peak.)
std::vector<Vec2> bright_points(const std::vector<OpenMesh>& meshes, double pixel_mm) {
  constexpr std::size_t kBits = 11, kMaxPoints = 6;
  constexpr double kFarthest = 1e15;  // squares, which can be counted
  std::vector<std::pair<double, Vec2>> table(std::size_t{1} << kBits);
  std::pair<double, Vec2> brightest{0.0, {}};
  for (const OpenMesh& mesh : meshes) {
    for_each_open_cell(mesh, [&](const OpenCell& cell) {
      const double level = level_of(mesh, cell, pixel_mm);
      Vec2 middle;
      for (const std::size_t vertex : cell.vertex) middle = middle + mesh.sensor_point_mm(vertex) * 0.25;
      if (level > brightest.first) brightest = {level, middle};
      if (!(std::abs(middle.x) + std::abs(middle.y) < kFarthest * pixel_mm)) return;
      const auto column = static_cast<std::int64_t>(std::floor(middle.x / pixel_mm));
      const auto row = static_cast<std::int64_t>(std::floor(middle.y / pixel_mm));
      constexpr std::uint64_t kFirst = 0x9E3779B97F4A7C15U, kSecond = 0xC2B2AE3D27D4EB4FU;  // large and odd
      const std::uint64_t key = static_cast<std::uint64_t>(column) * kFirst + static_cast<std::uint64_t>(row) * kSecond;
      auto& entry = table[key >> (64U - kBits)];
      entry.second = (entry.second * entry.first + middle * level) * (1.0 / (entry.first + level));
      entry.first += level;
    });
  }
  const auto is_brighter = [](const auto& a, const auto& b) { return a.first > b.first; };
  std::partial_sort(table.begin(), table.begin() + kMaxPoints, table.end(), is_brighter);
  std::vector<Vec2> points{brightest.second};
  for (std::size_t k = 0; k < kMaxPoints; ++k)
    if (table[k].first > 0.0) points.push_back(table[k].second);
  return points;
}

// All light that lands in a window: area on the entrance plane (mm^2) times transmittance.
double light_within(const TriangleWindow& window, const std::vector<OpenMesh>& meshes) {
  double light = 0.0;
  for (const OpenMesh& mesh : meshes) {
    for_each_open_cell(mesh, [&](const OpenCell& cell) {
      std::array<Vec2, 4> image;
      for (std::size_t k = 0; k < image.size(); ++k) image[k] = mesh.sensor_point_mm(cell.vertex[k]);
      if (window.misses(image)) return;
      const bool whole = window.holds(image);
      for (std::size_t half = 0; half < 2; ++half) {
        if (!(cell.open[half] > 0.0)) continue;
        const auto& v = kHalves[half];
        light +=
            light_of(mesh, cell, half) * (whole ? 1.0 : window.fraction_of({image[v[0]], image[v[1]], image[v[2]]}));
      }
    });
  }
  return light;
}

// The mean over a square about a point.
double mean_about(Vec2 point, const std::vector<OpenMesh>& meshes, double pixel_mm) {
  const Vec2 half{0.5 * pixel_mm, 0.5 * pixel_mm};
  return light_within(TriangleWindow({point - half, point + half}), meshes) / (pixel_mm * pixel_mm);
}

}  // namespace

Footprint::Footprint(std::vector<OpenMesh> meshes, double shared_flux)
    : meshes_(std::move(meshes)), shared_flux_(shared_flux) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  measure_.min_mm = {kFar, kFar};
  measure_.max_mm = {-kFar, -kFar};
  for (const OpenMesh& mesh : meshes_) add(mesh);
  if (measure_.flux_mm2 > 0.0) {
    measure_.centroid_mm = measure_.centroid_mm * (1.0 / measure_.flux_mm2);
    measure_.flux_mm2 *= shared_flux_;
  } else {
    measure_ = {};
    meshes_.clear();
  }
}

void Footprint::grow(Vec2 p) {
  measure_.min_mm = {std::min(measure_.min_mm.x, p.x), std::min(measure_.min_mm.y, p.y)};
  measure_.max_mm = {std::max(measure_.max_mm.x, p.x), std::max(measure_.max_mm.y, p.y)};
}

// The bounds contain the rays that get through, and the points where the pupil's edge crosses sides of cells.
void Footprint::add(const OpenMesh& mesh) {
  for (std::size_t k = 0; k < mesh.weight.size(); ++k) {
    if (mesh.weight[k] == 0.0) continue;
    const double flux = mesh.weight[k] * mesh.transmission[k];
    measure_.flux_mm2 += flux;
    measure_.centroid_mm = measure_.centroid_mm + mesh.sensor_point_mm(k) * flux;
  }
  for (std::size_t k = 0; k < mesh.blocked.size(); ++k)
    if (mesh.blocked[k] <= 0.0F) grow(mesh.sensor_point_mm(k));
  for_each_open_cell(mesh, [&](const OpenCell& cell) {
    if (cell.open[0] == 1.0 && cell.open[1] == 1.0) return;
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const std::size_t a = cell.vertex[corner], b = cell.vertex[(corner + 1) % 4];
      const double from = mesh.blocked[a], to = mesh.blocked[b];
      if ((from <= 0.0) != (to <= 0.0))
        grow(mesh.sensor_point_mm(a) + (mesh.sensor_point_mm(b) - mesh.sensor_point_mm(a)) * (from / (from - to)));
    }
  });
}

double Footprint::flux_within_mm2(const Rectangle& sensor_mm) const {
  const TriangleWindow window(sensor_mm);
  if (window.holds(std::array{measure_.min_mm, measure_.max_mm})) return measure_.flux_mm2;
  double whole = 0.0;
  for (const OpenMesh& mesh : meshes_)
    for_each_open_cell(mesh, [&](const OpenCell& cell) { whole += light_of(mesh, cell); });
  return whole > 0.0 ? measure_.flux_mm2 * (light_within(window, meshes_) / whole) : 0.0;
}

double Footprint::peak_per_mm2(double pixel_mm) const {
  double peak = 0.0;
  if (pixel_mm >= kMin_mm && pixel_mm <= kMax_mm) {
    for (const Vec2 point : bright_points(meshes_, pixel_mm))
      peak = std::max(peak, mean_about(point, meshes_, pixel_mm));
    return peak * shared_flux_;
  }
  for (const OpenMesh& mesh : meshes_)
    for_each_open_cell(mesh, [&](const OpenCell& cell) { peak = std::max(peak, level_of(mesh, cell, 0.0)); });
  return peak * shared_flux_;
}

}  // namespace contrejour::inline internal::pupils
