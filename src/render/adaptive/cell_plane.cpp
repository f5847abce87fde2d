#include "render/adaptive/cell_plane.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace contrejour::adaptive {
namespace {

constexpr double kThinnest_px2 = 0.5;  // mean square distance from the middle across them
constexpr double kDark = 0.05;         // of a vertex that light reaches, that one counts where it is blocked

struct Plane {
  double mean = 0;
  Vec2 slope;
  double squared_error = 0;
};

}  // namespace

static_assert(Mesh::kCells % 2 == 0);

void MeshLight::Sums::add(const Sums& other, int weights, double times) {
  for (std::size_t k = 0; k < kMoments; ++k) pixels[k] += times * other.pixels[k];
  for (std::size_t w = 0; w < static_cast<std::size_t>(weights); ++w)
    for (std::size_t k = 0; k < 4; ++k) light[w][k] += times * other.light[w][k];
}

MeshLight::Sums MeshLight::vertex_sums(std::size_t vertex, double share) const {
  const Vec2 p = mesh_.position(vertex) - origin_;
  const double pixels = share * std::abs(mesh_.area[vertex]);
  Sums out;
  out.pixels = {pixels, pixels * p.x, pixels * p.y, pixels * p.x * p.x, pixels * p.x * p.y, pixels * p.y * p.y};
  for (int w = 0; w < mesh_.layout.weights; ++w) {
    const double irradiance = mesh_.irradiance(w, vertex), light = pixels * irradiance;
    out.light[static_cast<std::size_t>(w)] = {light, light * p.x, light * p.y, light * irradiance};
  }
  return out;
}

// Simpson's rule over each block.
MeshLight::MeshLight(const Mesh& mesh, std::uint32_t blocked)
    : mesh_(mesh), origin_(mesh.position(Mesh::at(Mesh::kCells / 2, Mesh::kCells / 2))) {
  const bool turned = mesh.area[Mesh::at(0, 0)] < 0.0F;
  for (int y = 0; y < Mesh::kSide; ++y) {
    for (int x = 0; x < Mesh::kSide; ++x) {
      const std::size_t vertex = Mesh::at(x, y);
      const float area = mesh.area[vertex];
      const bool folds = !((area < 0.0F) == turned && area != 0.0F);
      const Sums sums = vertex_sums(vertex, (mesh.outside[vertex] & blocked) != 0 ? kDark : 1.0);
      const auto ends = [](int v) {
        return std::array{std::max(v - 1, 0) / kBlock, std::min(v, Mesh::kCells - 1) / kBlock};
      };
      const auto [low_x, high_x] = ends(x);
      const auto [low_y, high_y] = ends(y);
      const double share = (x % kBlock == 0 ? 1.0 : 4.0) * (y % kBlock == 0 ? 1.0 : 4.0) / 9.0;  // of a cell
      for (int by = low_y; by <= high_y; ++by) {
        for (int bx = low_x; bx <= high_x; ++bx) {
          const auto block = static_cast<std::size_t>(kBlocks * by + bx);
          blocks_[block].add(sums, mesh.layout.weights, share);
          folds_[block] = folds_[block] || folds;
        }
      }
    }
  }
}

std::optional<IrradiancePlane> MeshLight::plane(int ix, int iy, int size) const {
  const int weights = mesh_.layout.weights;
  Sums sums;
  for (int y = iy; y < iy + size; y += kBlock) {
    for (int x = ix; x < ix + size; x += kBlock) {
      const auto block = static_cast<std::size_t>(kBlocks * (y / kBlock) + x / kBlock);
      if (folds_[block]) return std::nullopt;
      sums.add(blocks_[block], weights, 1.0);
    }
  }
  const auto& m = sums.pixels;
  const Vec2 middle = Vec2{m[kX], m[kY]} * (1.0 / m[kOne]);
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
  for (std::size_t w = 0; w < static_cast<std::size_t>(weights); ++w) {
    const Plane& plane = planes[w] = plane_of(sums.light[w]);
    for (int corner = 0; corner < 4; ++corner) {
      const Vec2 p = mesh_.position(Mesh::at(ix + size * (corner % 2), iy + size * (corner / 2)));
      if (plane.mean + dot(plane.slope, p - origin_ - middle) < 0.0) return std::nullopt;
    }
  }

  IrradiancePlane out;
  out.area_px = m[kOne];
  const Vec2 at = middle + origin_ + mesh_.origin_px;
  out.shade.at = {static_cast<float>(at.x), static_cast<float>(at.y)};
  double squared_mean = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    const Plane& plane = planes[weights == 1 ? 0 : c];
    const double gain = mesh_.gain[c];
    out.shade.value[c] = static_cast<float>(gain * plane.mean);
    out.shade.along_x[c] = static_cast<float>(gain * plane.slope.x);
    out.shade.along_y[c] = static_cast<float>(gain * plane.slope.y);
    out.squared_error += gain * gain * plane.squared_error / 3.0;
    squared_mean += gain * gain * plane.mean * plane.mean / 3.0;
  }
  out.mean = std::sqrt(squared_mean);
  return out;
}

}  // namespace contrejour::adaptive
