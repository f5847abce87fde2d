// SPDX-License-Identifier: Apache-2.0
#include "polynomial/published/splat.h"

#include <algorithm>
#include <cmath>

#include "base/tasks.h"
#include "polynomial/published/seeded_random.h"

namespace contrejour::inline internal::polynomial {

void SplatTarget::add(Vec2 at, double weight) {
  // Upright, as a camera turns its picture: see frame.h.
  const double x = (1.0 - at.x / half_size.x) * 0.5 * width - 0.5, y = (1.0 + at.y / half_size.y) * 0.5 * height - 0.5;
  if (!(x > -1.0 && y > -1.0 && x < width && y < height)) return;
  const double left = std::floor(x), top = std::floor(y);
  for (const int dy : {0, 1}) {
    for (const int dx : {0, 1}) {
      const int px = static_cast<int>(left) + dx, py = static_cast<int>(top) + dy;
      if (px < 0 || py < 0 || px >= width || py >= height) continue;
      const double share = (dx == 1 ? x - left : 1.0 - (x - left)) * (dy == 1 ? y - top : 1.0 - (y - top));
      pixels[static_cast<std::size_t>(py) * static_cast<std::size_t>(width) + static_cast<std::size_t>(px)] +=
          weight * share;
    }
  }
}

void SplatTarget::add(const SplatTarget& other) {
  for (std::size_t k = 0; k < pixels.size(); ++k) pixels[k] += other.pixels[k];
}

Image SplatTarget::image() const {
  Image image(width, height, 1);
  std::ranges::transform(pixels, image.pixels.begin(), [](double v) { return static_cast<float>(v); });
  return image;
}

bool splat(SplatTarget& target, const RayAt& ray, const SplatPoints& points, double weight, const Context& context) {
  constexpr int kBands = 8;
  const int side = points.side;
  const double each = weight / (static_cast<double>(side) * side);
  return ordered_pipeline(
      kBands, context,
      [&](std::size_t band) {
        SplatTarget part(target.width, target.height, target.half_size);
        const int first = static_cast<int>(band) * side / kBands, last = (static_cast<int>(band) + 1) * side / kBands;
        SeededRandom random(points.seed * kBands + band);
        for (int row = first; row < last; ++row) {
          for (int column = 0; column < side; ++column) {
            Vec2 unit{random.unit(), random.unit()};
            if (!points.random) unit = {(column + unit.x) / side, (row + unit.y) / side};
            if (const auto found = ray(unit)) part.add(found->at, each * found->weight);
          }
        }
        return part;
      },
      [&](std::size_t, const SplatTarget& part) { target.add(part); });
}

}  // namespace contrejour::inline internal::polynomial
