// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/moving_light.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace contrejour {
namespace {

constexpr int kCellsAlong = 128;          // of the longer side of a streak's raster
constexpr int kStepsPerCell = 4;          // of a light on its way through a cell
constexpr int kSubsamples = 4;            // across a cell at the rim of a disc
constexpr double kLeastPath_rad = 1e-7;   // shorter ones leave a point light as it is
constexpr double kLeastPathOfDisc = 1e-4;  // in radii

// The direction halfway in time.
Vec3 middle_of(std::span<const Vec3> path) {
  const std::size_t last = path.size() - 1;
  return normalized(path[last / 2] + path[(last + 1) / 2]);
}

// Tangents of the angle from a direction; for one more than 89.9 degrees away, tangents far beyond any light's extent,
// so that renderers refuse the light (check_extent) instead of seeing its reflection through the camera.
Vec2 tangents_to(Vec3 from, Vec3 direction) {
  constexpr double kLeastCosine = 1.7e-3;
  const Vec2 tangents = tangents_between(from, direction);
  const double cosine = dot(normalized(from), normalized(direction));
  return cosine >= kLeastCosine ? tangents : tangents * (cosine / kLeastCosine);
}

bool is_finite(Vec2 v) { return std::isfinite(v.x) && std::isfinite(v.y); }

struct Box {
  Vec2 least, most;
};

Box box_of(std::span<const Vec2> points, double margin) {
  Box box{points.front(), points.front()};
  for (const Vec2 p : points) {
    box.least = {std::min(box.least.x, p.x), std::min(box.least.y, p.y)};
    box.most = {std::max(box.most.x, p.x), std::max(box.most.y, p.y)};
  }
  return {box.least - Vec2{margin, margin}, box.most + Vec2{margin, margin}};
}

// A raster over a path whose x axis follows the line from its start to its end.
struct Raster {
  Vec2 along{1, 0}, across{0, 1};  // unit vectors in tangents
  Vec2 corner;                     // along them, of the first cell
  double cell = 0.0;
  Image level;

  [[nodiscard]] Vec2 cell_of(Vec2 tangents) const {
    return (Vec2{dot(tangents, along), dot(tangents, across)} - corner) * (1.0 / cell);
  }
};

Raster raster_of(const std::vector<Vec2>& path, double radius) {
  Raster raster;
  const Vec2 chord = path.back() - path.front();
  if (length(chord) > 0.0) raster.along = chord * (1.0 / length(chord));
  raster.across = {-raster.along.y, raster.along.x};
  std::vector<Vec2> turned;
  for (const Vec2 p : path) turned.push_back({dot(p, raster.along), dot(p, raster.across)});
  const Box box = box_of(turned, radius);
  const Vec2 extent = box.most - box.least;
  raster.cell = std::max(extent.x, extent.y) / kCellsAlong;
  // One cell more on each side, for the light that is shared by neighbours.
  const auto cells = [&](double side) { return static_cast<int>(std::ceil(side / raster.cell - 1e-9)) + 2; };
  raster.level = Image(cells(extent.x), cells(extent.y), 1);
  const Vec2 middle = (box.least + box.most) * 0.5;
  raster.corner = middle - Vec2{0.5 * raster.level.width, 0.5 * raster.level.height} * raster.cell;
  return raster;
}

// Adds light at a place, shared by the four cells nearest to it.
void add_point(Image& level, Vec2 cell, double light) {
  const double x = cell.x - 0.5, y = cell.y - 0.5;
  const int x0 = static_cast<int>(std::floor(x)), y0 = static_cast<int>(std::floor(y));
  for (const int dy : {0, 1}) {
    for (const int dx : {0, 1}) {
      const int px = std::clamp(x0 + dx, 0, level.width - 1), py = std::clamp(y0 + dy, 0, level.height - 1);
      const double wx = dx == 0 ? 1.0 - (x - x0) : x - x0, wy = dy == 0 ? 1.0 - (y - y0) : y - y0;
      level.at(px, py, 0) += static_cast<float>(light * wx * wy);
    }
  }
}

// The path of a point: every segment takes the same time.
void add_path(Raster& raster, std::span<const Vec2> path) {
  for (std::size_t k = 0; k + 1 < path.size(); ++k) {
    const Vec2 from = raster.cell_of(path[k]), to = raster.cell_of(path[k + 1]);
    const int steps = 1 + static_cast<int>(std::ceil(kStepsPerCell * length(to - from)));
    for (int s = 0; s < steps; ++s) add_point(raster.level, from + (to - from) * ((s + 0.5) / steps), 1.0 / steps);
  }
}

// A disc about the middle of an odd square of cells, by the part of each cell inside it.
Image disc_of(double radius_cells) {
  const int reach = static_cast<int>(std::ceil(radius_cells));
  Image disc(2 * reach + 1, 2 * reach + 1, 1);
  for (int y = 0; y < disc.height; ++y)
    for (int x = 0; x < disc.width; ++x)
      for (int s = 0; s < kSubsamples * kSubsamples; ++s) {
        const Vec2 at{x - reach - 0.5 + (s % kSubsamples + 0.5) / kSubsamples,
                      y - reach - 0.5 + (s / kSubsamples + 0.5) / kSubsamples};
        if (length(at) <= radius_cells) disc.at(x, y, 0) += 1.0F;
      }
  return disc;
}

// Every point of the picture becomes a disc.
Image with_discs(const Image& points, const Image& disc) {
  Image sum(points.width, points.height, 1);
  const int reach = disc.width / 2;
  for (int y = 0; y < points.height; ++y)
    for (int x = 0; x < points.width; ++x) {
      const float light = points.at(x, y, 0);
      if (light == 0.0F) continue;
      for (int dy = std::max(-reach, -y); dy <= std::min(reach, points.height - 1 - y); ++dy)
        for (int dx = std::max(-reach, -x); dx <= std::min(reach, points.width - 1 - x); ++dx)
          sum.at(x + dx, y + dy, 0) += light * disc.at(reach + dx, reach + dy, 0);
    }
  return sum;
}

LightShape shape_of(Raster raster) {
  LightShape shape;
  shape.centre_px = raster.cell_of({0.0, 0.0});
  shape.right = raster.along * raster.cell;
  shape.down = raster.across * raster.cell;
  shape.level = std::move(raster.level);
  return shape;
}

}  // namespace

Light swept_light(Light light, std::span<const Vec3> path) {
  assert(!path.empty());
  if (light.shape) return light;
  light.direction = middle_of(path);
  std::vector<Vec2> tangents;
  for (const Vec3 direction : path) {
    tangents.push_back(tangents_to(light.direction, direction));
    if (is_finite(tangents.back())) continue;
    light.direction = direction;  // no light is there, and renderers say so (check_light)
    return light;
  }
  const Box box = box_of(tangents, 0.0);
  const double extent = std::max(box.most.x - box.least.x, box.most.y - box.least.y);
  if (extent <= std::max(kLeastPath_rad, kLeastPathOfDisc * light.radius_rad)) return light;
  const double radius = std::tan(light.radius_rad);
  Raster raster = raster_of(tangents, radius);
  add_path(raster, tangents);
  if (radius > 0.0) raster.level = with_discs(raster.level, disc_of(radius / raster.cell));
  light.shape = std::make_shared<const LightShape>(shape_of(std::move(raster)));
  light.radius_rad = 0.0;
  return light;
}

}  // namespace contrejour
