// SPDX-License-Identifier: Apache-2.0
#include "render/polygons/pattern_atlas.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "contrejour/expert/iris_field.h"

namespace contrejour::inline internal::raster {

// At a sample's own point interpolation gives the sample, whose bits rounding to a float restores.
OutlineTable::OutlineTable(const Iris& iris) {
  if (!iris.field) return;
  side = iris.field->samples() + 2;
  cosine = std::cos(iris.rotation_rad);
  sine = std::sin(iris.rotation_rad);
  const double per_sample = 2.0 / iris.field->samples();
  distances.reserve(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  for (int row = 0; row < side; ++row)
    for (int column = 0; column < side; ++column) {
      const Vec2 at{(column - 0.5) * per_sample - 1.0, (row - 0.5) * per_sample - 1.0};
      distances.push_back(static_cast<float>(iris.field->distance(at)));
    }
}

// As IrisField::distance().
double OutlineTable::distance(Vec2 stop) const {
  const Vec2 p{cosine * stop.x + sine * stop.y, cosine * stop.y - sine * stop.x};
  const double scale = 0.5 * (side - 2), last = side - 1;
  const double u = (p.x + 1.0) * scale + 0.5, v = (p.y + 1.0) * scale + 0.5;
  const double x = std::fmin(std::fmax(u, 0.0), last);  // 0 for a NaN
  const double y = std::fmin(std::fmax(v, 0.0), last);
  const int i = std::min(static_cast<int>(x), side - 2), j = std::min(static_cast<int>(y), side - 2);
  const float* const row = distances.data() + static_cast<std::size_t>(j) * static_cast<std::size_t>(side) + i;
  const double below = std::lerp(static_cast<double>(row[0]), static_cast<double>(row[1]), x - i);
  const double above = std::lerp(static_cast<double>(row[side]), static_cast<double>(row[side + 1]), x - i);
  const double inside = std::lerp(below, above, y - j);
  return u == x && v == y ? inside : inside + length(Vec2{u - x, v - y}) / scale;
}

std::uint32_t PatternAtlas::add(TextureTable texture) {
  const std::scoped_lock lock(mutex_);
  textures_.push_back(std::move(texture));
  return static_cast<std::uint32_t>(textures_.size() - 1);
}

const TextureTable& PatternAtlas::texture(std::uint32_t index) const {
  const std::scoped_lock lock(mutex_);
  return textures_[index];
}

std::vector<const TextureTable*> PatternAtlas::textures() const {
  const std::scoped_lock lock(mutex_);
  std::vector<const TextureTable*> all;
  for (const TextureTable& texture : textures_) all.push_back(&texture);
  return all;
}

std::size_t PatternAtlas::bytes() const {
  const std::scoped_lock lock(mutex_);
  std::size_t sum = outline_.distances.size() * sizeof(float);
  for (const TextureTable& texture : textures_)
    sum += texture.pairs.size() * sizeof(TextureTable::Pair) + texture.samples.size() * sizeof(float);
  return sum;
}

}  // namespace contrejour::inline internal::raster
