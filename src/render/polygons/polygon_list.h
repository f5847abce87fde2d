// SPDX-License-Identifier: Apache-2.0
// The polygons that a rasteriser draws, in pixels of the frame, as arrays of numbers that refer to each other by index:
// they can be copied to a device as they are. Each polygon has an irradiance that is linear over it, and may lie behind
// a pattern, which multiplies its light by a transmittance for each pixel. Polygons are convex except for sides that
// follow a curve.
// Thread-safety: a value.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "contrejour/expert/iris.h"
#include "contrejour/expert/vec.h"

namespace contrejour::inline internal::raster {

struct Point {
  float x = 0, y = 0;
  friend bool operator==(const Point&, const Point&) = default;
};

using Channels = std::array<float, 4>;  // with one unused: four are read at once

// Pixel value per pixel area and channel: the value at a point, and its change along x and y.
struct LinearIrradiance {
  Point at;
  Channels value{}, along_x{}, along_y{};
  friend bool operator==(const LinearIrradiance&, const LinearIrradiance&) = default;
};

// Positive where the corners turn from +x to +y.
[[nodiscard]] inline double twice_signed_area(std::span<const Point> corners) {
  const auto from_first = [&](std::size_t k) {
    return Vec2{static_cast<double>(corners[k].x) - corners[0].x, static_cast<double>(corners[k].y) - corners[0].y};
  };
  double twice = 0.0;
  for (std::size_t k = 2; k < corners.size(); ++k) twice += cross(from_first(k - 1), from_first(k));
  return twice;
}

// From pixels to the points at which their light crosses the stop, in stop radii: a polynomial of second order in the
// pixel q relative to the origin, level + x q.x + y q.y + xx q.x^2 + xy q.x q.y + yy q.y^2.
struct PatternMap {
  Vec2 origin_px;
  Vec2 level, x, y, xx, xy, yy;
  double width = 0.0;  // of a pixel, or of the part of one that a sample stands for, stop radii

  [[nodiscard]] Vec2 stop_point(Vec2 pixel) const {
    const Vec2 q = pixel - origin_px;
    return level + x * q.x + y * q.y + xx * (q.x * q.x) + xy * (q.x * q.y) + yy * (q.y * q.y);
  }
  // The polynomial of weights . stop_point + more.
  struct Form {
    float level = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  };
  [[nodiscard]] Form form(Vec2 weights, double more) const {
    const auto of = [&](Vec2 term) { return static_cast<float>(dot(weights, term)); };
    return {static_cast<float>(dot(weights, level) + more), of(x), of(y), of(xx), of(xy), of(yy)};
  }
};

enum class PatternKind : std::uint32_t {
  EdgeFringes,  // the product of a table's factors at the distances from some bounds of the iris
  Texture,  // a texture of the atlas, looked up in the stop
  Pixels,  // a transmittance for each pixel
};

struct Pattern {
  PatternKind kind = PatternKind::Pixels;
  std::uint32_t table = 0;  // EdgeFringes: in PolygonList::edge_tables. Texture: in PatternAtlas
  std::uint32_t level = 0;  // Texture: one of its levels
  std::uint32_t weights = 0;  // Texture: in PolygonList::weights
  // EdgeFringes: in PolygonList::active, the bounds whose fringes reach the polygon. Pixels: in PolygonList::spans, the
  // polygon's rows from top to bottom.
  std::uint32_t first = 0, count = 0;
  std::uint32_t samples = 1;  // across a pixel, and down it, of which the mean is taken; 1 for Pixels
  PatternMap map = {};  // not for Pixels
};

// The factors of one bound at even steps of the distance, from 0 at dark_beyond outside it to 1 at level_within inside.
struct EdgeTable {
  bool is_monochrome = false;  // one factor serves all channels
  bool of_outline = false;  // the distance is that of the atlas's outline, and no bounds are listed
  std::uint32_t first = 0, count = 0;  // entries: in PolygonList::edge_steps if grey, else in edge_factors
  double dark_beyond = 0.0, level_within = 0.0;  // stop radii
  double per_step = 1.0;  // entries a stop radius
};
struct EdgeStep {
  float factor = 0, slope = 0;  // slope: to the next factor; 0 at the last
};

// The fraction of each channel's light that each wavelength of a texture has.
using WavelengthWeights = std::array<Channels, 3>;

// A row of pixels: `count` values of PolygonList::pixels, of the columns from x on.
struct PixelSpan {
  std::int32_t x = 0, y = 0;
  std::uint32_t first = 0, count = 0;
};

struct Polygon {
  std::uint32_t first = 0;  // index in PolygonList::corners
  std::uint32_t count = 0;  // 1: a point that carries Shade::value
  std::uint32_t irradiance = 0;  // index in PolygonList::shades
  std::uint32_t pattern = 0;  // k + 1: PolygonList::patterns[k]; 0: none
  std::uint32_t turns_left = 0;  // 1: from +x to +y
};

struct PolygonList {
  static constexpr std::uint32_t kUnshared = ~0U, kSkipped = ~0U - 1;

  std::vector<Point> corners;
  // For each corner, whether the edge from there to the next corner is drawn, and the other polygon for which it is
  // drawn as well. Empty: every edge is drawn for its own polygon alone.
  std::vector<std::uint32_t> neighbour;
  std::vector<Polygon> polygons;
  std::vector<LinearIrradiance> irradiances;

  std::vector<Pattern> patterns;
  std::vector<IrisBound> bounds;  // of the iris
  std::vector<std::uint16_t> active;  // indices of bounds
  std::vector<EdgeTable> edge_tables;
  std::vector<EdgeStep> edge_steps;
  std::vector<Channels> edge_factors;
  std::vector<WavelengthWeights> weights;
  std::vector<PixelSpan> spans;
  std::vector<std::array<float, 3>> pixels;  // transmittances, by channel

  void add(std::span<const Point> polygon, const LinearIrradiance& irradiance) {
    if (irradiances.empty() || !(irradiances.back() == irradiance)) irradiances.push_back(irradiance);
    polygons.push_back({static_cast<std::uint32_t>(corners.size()), static_cast<std::uint32_t>(polygon.size()),
                        static_cast<std::uint32_t>(irradiances.size() - 1), 0,
                        twice_signed_area(polygon) > 0.0 ? 1U : 0U});
    corners.insert(corners.end(), polygon.begin(), polygon.end());
  }
  void add(std::span<const Point> polygon, const LinearIrradiance& irradiance, const Pattern& behind) {
    add(polygon, irradiance);
    patterns.push_back(behind);
    polygons.back().pattern = static_cast<std::uint32_t>(patterns.size());
  }
  [[nodiscard]] std::uint32_t neighbour_of(std::size_t corner) const {
    return neighbour.empty() ? kUnshared : neighbour[corner];
  }
  [[nodiscard]] std::span<const Point> corners_of(const Polygon& p) const {
    return {corners.data() + p.first, p.count};
  }
  [[nodiscard]] const LinearIrradiance& irradiance_of(const Polygon& p) const { return irradiances[p.irradiance]; }
  [[nodiscard]] std::size_t bytes() const {
    const auto of = [](const auto& array) { return array.size() * sizeof array[0]; };
    return of(corners) + of(neighbour) + of(polygons) + of(irradiances) + of(patterns) + of(spans) + of(pixels);
  }
};

}  // namespace contrejour::inline internal::raster

namespace contrejour::inline internal::adaptive {
using namespace raster;  // the renderer whose polygons these are
}  // namespace contrejour::inline internal::adaptive
