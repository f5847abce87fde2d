// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/kernel.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal::area {
namespace {

constexpr double kFarthest = 2.0;  // pixels beyond the shape: for tents, and for the offset of a displaced picture
constexpr double kFinest = 0.4;  // pixels between the points that represent a square
constexpr int kMaxPoints = 64;  // of them along a side
constexpr int kHalvings = 6;  // bisections, to find the scale of a narrow kernel
constexpr double kTentVariance = 1.0 / 6.0;  // of a point spread over its four nearest pixels, in squares of a pixel

// Makes the map narrower by the variance that the tents and later steps add. The level's pixels add none: drawing
// averages over squares, which widens the image, and upsampling, which takes values as averages over squares, undoes
// that.
LinearMap narrowed(const LightPiece& piece, const LinearMap& map, double added) {
  const LinearMap wanted = mapped_covariance(map, piece.covariance);
  const LinearMap root = square_root(wanted);
  if (!(root.determinant() > 1e-12)) return map;
  LinearMap less = wanted - LinearMap{} * added;
  const Vec2 e = eigenvalues(less);
  // No width is left across a shape that is narrower than the pixels.
  if (e.x < 0.0) {
    const double difference = e.y - e.x;
    if (e.y <= 0.0) return kZeroMap;
    less = (less - LinearMap{} * e.x) * (e.y / difference);
  }
  return square_root(less) * inverse(root) * map;
}

int points_along(Vec2 side_px) {
  return std::clamp(static_cast<int>(std::ceil(std::max(std::abs(side_px.x), std::abs(side_px.y)) / kFinest)), 1,
                    kMaxPoints);
}

}  // namespace

KernelExtent extent_of(const LightPiece& piece, const LinearMap& map) {
  Vec2 low, high;
  const Vec2 right = map(piece.right) * 0.5, down = map(piece.down) * 0.5;
  const Vec2 square{std::abs(right.x) + std::abs(down.x), std::abs(right.y) + std::abs(down.y)};
  for (const ShapeSample& s : piece.samples) {
    const Vec2 at = map(s.at);
    low = {std::min(low.x, at.x - square.x), std::min(low.y, at.y - square.y)};
    high = {std::max(high.x, at.x + square.x), std::max(high.y, at.y + square.y)};
  }
  const auto whole = [](double px) { return static_cast<int>(std::ceil(px + kFarthest)); };
  return {whole(-low.x), whole(high.x), whole(-low.y), whole(high.y)};
}

namespace {

// Places the shape on pixels, under the given map.
Kernel laid(const LightPiece& piece, const KernelExtent& extent, const LinearMap& map, Vec2 moved) {
  Kernel kernel;
  kernel.extent = extent;
  kernel.weight.resize(static_cast<std::size_t>(kernel.width()) * static_cast<std::size_t>(kernel.height()));
  const Vec2 right = map(piece.right), down = map(piece.down);
  const int columns = points_along(right), rows = points_along(down);
  const double weight = 1.0 / (static_cast<double>(columns) * rows);
  for (const ShapeSample& s : piece.samples) {
    const Vec2 corner = map(s.at) - right * 0.5 - down * 0.5 - moved;
    for (int k = 0; k < columns * rows; ++k) {
      const Vec2 at = corner + right * ((k % columns + 0.5) / columns) + down * ((k / columns + 0.5) / rows);
      const double x = at.x + kernel.extent.left, y = at.y + kernel.extent.up;
      const double column = std::floor(x), row = std::floor(y), u = x - column, v = y - row;
      const std::size_t first =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(kernel.width()) + static_cast<std::size_t>(column);
      const std::size_t below = first + static_cast<std::size_t>(kernel.width());
      for (std::size_t c = 0; c < 3; ++c) {
        const double w = weight * s.fraction[c];
        kernel.weight[first][c] += w * (1.0 - u) * (1.0 - v);
        kernel.weight[first + 1][c] += w * u * (1.0 - v);
        kernel.weight[below][c] += w * (1.0 - u) * v;
        kernel.weight[below + 1][c] += w * u * v;
      }
    }
  }
  return kernel;
}

// The variance, summed over both axes.
double variance_of(const Kernel& kernel) {
  double sum = 0.0, squares = 0.0;
  Vec2 mean;
  for (std::size_t k = 0; k < kernel.weight.size(); ++k) {
    const Rgb& weight = kernel.weight[k];
    const double w = weight[0] + weight[1] + weight[2];
    const Vec2 at{static_cast<double>(k % static_cast<std::size_t>(kernel.width())),
                  static_cast<double>(k / static_cast<std::size_t>(kernel.width()))};
    sum += w;
    mean = mean + at * w;
    squares += w * dot(at, at);
  }
  return squares / sum - dot(mean, mean) / (sum * sum);
}

}  // namespace

Kernel make_kernel(const LightPiece& piece, const LinearMap& px_from_tangents, Vec2 moved, double spread) {
  const KernelExtent extent = extent_of(piece, px_from_tangents);
  const LinearMap wanted = mapped_covariance(px_from_tangents, piece.covariance);
  const double added = kTentVariance + spread;
  if (eigenvalues(wanted).y > added) return laid(piece, extent, narrowed(piece, px_from_tangents, added), moved);
  // The shape is narrower than a pixel's tent in every direction: the map is scaled down until the kernel has the right
  // width.
  const double variance = trace_of(wanted) - 2.0 * spread;
  double low = 0.0, high = 1.0;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (variance_of(laid(piece, extent, px_from_tangents * middle, moved)) > variance ? high : low) = middle;
  }
  return laid(piece, extent, px_from_tangents * low, moved);
}

}  // namespace contrejour::inline internal::area
