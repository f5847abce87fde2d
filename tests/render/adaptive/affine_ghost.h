// SPDX-License-Identifier: Apache-2.0
// A ghost of constant transmittance as a patch, and the polygons painted of it.
#pragma once

#include <cmath>
#include <vector>

#include "contrejour/frame.h"
#include "render/adaptive/tessellator.h"
#include "render/ray_maps/lobatto.h"

namespace contrejour::test {

using adaptive::Patch;
using adaptive::PatchLayout;
using adaptive::PolygonList;

// v -> matrix * v + offset, both pairs.
struct Affine {
  Vec2 along_u{1, 0}, along_v{0, 1}, offset{};
  [[nodiscard]] Vec2 operator()(Vec2 uv) const { return along_u * uv.x + along_v * uv.y + offset; }
  [[nodiscard]] double determinant() const { return cross(along_u, along_v); }
};

// A ghost of constant transmittance over u, v in -1..1 with affine maps to the sensor, the stop's crossings and the
// rims.
struct AffineGhost {
  int nodes = 5;
  Affine pixels;
  std::vector<Affine> stops;
  std::vector<Affine> rims;  // to coordinates over the semi-diameter
  double flux = 3.0;         // of the whole box, green; red has twice as much, blue none
  int weights = 1;           // or 3
  double sag_px = 0.0;      // by which corners at u = 1 are farther along y, with (u + 1)^4, and back at v = 0

  [[nodiscard]] Patch patch() const {
    Patch patch;
    patch.nodes = nodes;
    patch.layout = {static_cast<int>(stops.size()), static_cast<int>(rims.size()), weights};
    patch.flux_area_mm2 = flux;
    if (weights == 1) patch.gain = {2.0, 1.0, 0.0};
    patch.origin_px = {std::floor(pixels.offset.x), std::floor(pixels.offset.y)};
    patch.values.resize(static_cast<std::size_t>(patch.layout.fields()) * patch.size());
    const auto points = ray_maps::lobatto_points(nodes);
    for (std::size_t k = 0; k < patch.size(); ++k) {
      const auto n = static_cast<std::size_t>(nodes);
      const Vec2 uv{points[k % n], points[k / n]};
      const auto set = [&](int field, double value) { patch.field(field)[k] = static_cast<float>(value); };
      const Vec2 sag{0.0, sag_px * std::pow(0.5 * (uv.x + 1.0), 4) * (2.0 * uv.y * uv.y - 1.0)};
      const Vec2 p = pixels(uv) + sag - patch.origin_px;
      set(PatchLayout::kX, p.x);
      set(PatchLayout::kY, p.y);
      set(patch.layout.weight(0), weights == 1 ? 1.0 : 2.0);
      if (weights == 3) set(patch.layout.weight(1), 1.0);
      for (std::size_t c = 0; c < stops.size(); ++c) {
        const Vec2 s = stops[c](uv);
        set(PatchLayout::kStop + 2 * static_cast<int>(c), s.x);
        set(PatchLayout::kStop + 2 * static_cast<int>(c) + 1, s.y);
      }
      for (std::size_t r = 0; r < rims.size(); ++r)
        set(patch.layout.rim(static_cast<int>(r)), dot(rims[r](uv), rims[r](uv)));
    }
    return patch;
  }

  // The fraction of the box that gets through, by counting points of a grid.
  [[nodiscard]] double open_fraction(const Iris& iris, int side = 1000) const {
    int open = 0;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const Vec2 uv{(2.0 * x + 1.0) / side - 1.0, (2.0 * y + 1.0) / side - 1.0};
        bool passes = true;
        for (const Affine& stop : stops) passes = passes && iris_distance(iris, stop(uv)) <= 0.0;
        for (const Affine& rim : rims) passes = passes && dot(rim(uv), rim(uv)) <= 1.0;
        open += passes ? 1 : 0;
      }
    }
    return static_cast<double>(open) / (static_cast<double>(side) * side);
  }
};

inline constexpr int kWidth = 320;
inline constexpr int kHeight = 200;

inline Frame frame_px() { return {kWidth, kHeight, 0, 0, kWidth, kHeight, 0.01}; }

// error: RMS, relative to the ghost's mean level over its area.
inline PolygonList tessellated(const AffineGhost& ghost, const Iris& iris, double error = 1e-3) {
  const double area_px = std::max(4.0 * std::abs(ghost.pixels.determinant()), 1.0);
  const double level = 2.0 * ghost.flux / area_px;
  PolygonList list;
  const IrisShape shape(iris);
  const Frame frame = frame_px();
  adaptive::BoxCells room;
  adaptive::Tessellator tessellator(shape, frame, {error * error * level * level * area_px, level}, 64.0, room, list);
  tessellator.choose(ghost.patch(), {});
  tessellator.emit();
  return list;
}

}  // namespace contrejour::test
