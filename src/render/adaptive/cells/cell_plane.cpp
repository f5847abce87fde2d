// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/cells/cell_plane.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/adaptive/cells/cell_shape.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kThinnest_px2 = 0.5;  // mean square distance from the middle, across the thin direction
constexpr double kDark = 0.05;         // weight of a blocked vertex over that of one that light reaches

struct Plane {
  double mean = 0;
  Vec2 slope;
  double squared_error = 0;
};

// Sums use positions relative to this point, since cells lie far from the patch's origin.
Vec2 middle_of(const Mesh& mesh) { return mesh.position(Mesh::at(Mesh::kCells / 2, Mesh::kCells / 2)); }

}  // namespace

LightSums::LightSums(const Mesh& mesh, const MeshSquare& square, std::uint32_t blocked)
    : weights_(mesh.layout.weights) {
  const Vec2 origin = middle_of(mesh);
  const int half = square.size / 2;
  const bool mirrored = mesh.area[Mesh::at(square.ix, square.iy)] < 0.0F;
  for (std::size_t k = 0; k < 9; ++k) {
    const std::size_t vertex =
        Mesh::at(square.ix + half * static_cast<int>(k % 3), square.iy + half * static_cast<int>(k / 3));
    const double area = mesh.area[vertex];
    folds_ = folds_ || !((area < 0.0) == mirrored && area != 0.0);
    const Vec2 p = mesh.position(vertex) - origin;
    const double cells = kSimpson[k % 3] * kSimpson[k / 3] * square.size * square.size;
    const double pixels = ((mesh.outside[vertex] & blocked) != 0 ? kDark : 1.0) * cells * std::abs(area);
    const double x = pixels * p.x, y = pixels * p.y;
    const std::array<double, kMoments> moments{pixels, x, y, x * p.x, x * p.y, y * p.y};
    for (std::size_t m = 0; m < kMoments; ++m) pixels_[m] += moments[m];
    for (int w = 0; w < weights_; ++w) {
      auto& sums = light_[static_cast<std::size_t>(w)];
      const double irradiance = mesh.irradiance(w, vertex), light = pixels * irradiance;
      sums[0] += light;
      sums[1] += light * p.x;
      sums[2] += light * p.y;
      sums[3] += light * irradiance;
    }
  }
}

void LightSums::add(const LightSums& other) {
  folds_ = folds_ || other.folds_;
  for (std::size_t m = 0; m < kMoments; ++m) pixels_[m] += other.pixels_[m];
  for (std::size_t w = 0; w < static_cast<std::size_t>(weights_); ++w)
    for (std::size_t k = 0; k < 4; ++k) light_[w][k] += other.light_[w][k];
}

std::optional<IrradiancePlane> LightSums::plane(const Mesh& mesh, const MeshSquare& square) const {
  if (folds_) return std::nullopt;
  const auto& m = pixels_;
  const Vec2 origin = middle_of(mesh), middle = Vec2{m[kX], m[kY]} * (1.0 / m[kOne]);
  const double xx = m[kXX] - m[kX] * middle.x, xy = m[kXY] - m[kX] * middle.y, yy = m[kYY] - m[kY] * middle.y;
  const double across = 0.5 * (xx + yy - std::hypot(xx - yy, 2.0 * xy));
  if (!(across > kThinnest_px2 * m[kOne])) return std::nullopt;

  const auto plane_of = [&](const std::array<double, 4>& light) {
    const double ex = light[1] - light[0] * middle.x, ey = light[2] - light[0] * middle.y;
    Plane plane{light[0] / m[kOne], Vec2{yy * ex - xy * ey, xx * ey - xy * ex} * (1.0 / (xx * yy - xy * xy))};
    plane.squared_error = std::max(0.0, light[3] - light[0] * plane.mean - dot(plane.slope, {ex, ey}));
    return plane;
  };
  std::array<Plane, 3> planes;
  for (std::size_t w = 0; w < static_cast<std::size_t>(weights_); ++w) {
    const Plane& plane = planes[w] = plane_of(light_[w]);
    for (int corner = 0; corner < 4; ++corner) {
      const Vec2 p =
          mesh.position(Mesh::at(square.ix + square.size * (corner % 2), square.iy + square.size * (corner / 2)));
      if (plane.mean + dot(plane.slope, p - origin - middle) < 0.0) return std::nullopt;
    }
  }

  IrradiancePlane out;
  out.area_px = m[kOne];
  const Vec2 at = middle + origin + mesh.origin_px;
  out.irradiance.at = {static_cast<float>(at.x), static_cast<float>(at.y)};
  double squared_mean = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    const Plane& plane = planes[weights_ == 1 ? 0 : c];
    const double gain = mesh.gain[c];
    out.irradiance.value[c] = static_cast<float>(gain * plane.mean);
    out.irradiance.along_x[c] = static_cast<float>(gain * plane.slope.x);
    out.irradiance.along_y[c] = static_cast<float>(gain * plane.slope.y);
    out.squared_error += gain * gain * plane.squared_error / 3.0;
    squared_mean += gain * gain * plane.mean * plane.mean / 3.0;
  }
  out.mean = std::sqrt(squared_mean);
  return out;
}

}  // namespace contrejour::inline internal::adaptive
