// SPDX-License-Identifier: Apache-2.0
// The polygons to draw, in pixels of the frame. Each has an irradiance that is linear over it. They are convex except
// for sides that follow a curve.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "contrejour/expert/vec.h"
#include "render/adaptive/tiles/edge_table.h"
#include "render/adaptive/tiles/stop_map.h"
#include "render/stop_patterns/band_dirt.h"

namespace contrejour::inline internal::adaptive {

struct Point {
  float x = 0, y = 0;
  friend bool operator==(const Point&, const Point&) = default;
};

using Channels = std::array<float, 4>;  // with one unused: four are read at once

// Pixel value per pixel area and channel: the value at a point, and its change along x and y.
struct Shade {
  Point at;
  Channels value{}, along_x{}, along_y{};
  friend bool operator==(const Shade&, const Shade&) = default;
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

// Dirt in front of a polygon that is looked up for each pixel, and the map from pixels to its plane, in mm.
struct PastDirt {
  const stop_patterns::BandDirt* band;
  StopMap map;
  [[nodiscard]] std::array<double, 3> passed(Vec2 pixel) const;
};

// A stop pattern in front of a polygon: the map from pixels to the stop, and the tables that are looked up there.
struct Screened {
  StopMap map;
  const stop_patterns::BandStopPattern* pattern;  // null: there is only dirt
  const EdgeTable* edges = nullptr;  // of `pattern`, if it consists of edges' fringes
  std::uint32_t first = 0, count = 0;  // in PolygonList::bounds: bounds whose fringes reach the polygon
  std::uint32_t dirt = 0;              // k + 1: PolygonList::dirt[k]; 0: none
  int looks = 1;  // look-ups across a pixel, and down it; `map` has the width of the part of one
};

struct Polygon {
  std::uint32_t first = 0;  // index in PolygonList::corners
  std::uint32_t count = 0;  // 1: a point that carries shade.value
  Shade shade;
  std::uint32_t screened = 0;  // k + 1: PolygonList::screened[k]; 0: none
  bool turns_left = false;     // from +x to +y
};

struct PolygonList {
  static constexpr std::uint32_t kAlone = ~0U, kNotDrawn = ~0U - 1;

  std::vector<Point> corners;
  // For each corner, whether the edge from there to the next corner is drawn, and the other polygon for which it is
  // drawn as well. Empty: every edge is drawn for its own polygon alone.
  std::vector<std::uint32_t> partner;
  std::vector<Polygon> polygons;
  std::vector<Screened> screened;
  std::vector<PastDirt> dirt;
  std::vector<std::uint16_t> bounds;
  std::vector<std::shared_ptr<const stop_patterns::BandStopPattern>> patterns;  // that `screened` points to
  std::vector<std::shared_ptr<const EdgeTable>> tables;
  std::vector<std::shared_ptr<const stop_patterns::BandDirt>> band_dirt;  // that `dirt` points to

  void add(std::span<const Point> polygon, const Shade& shade) {
    polygons.push_back({static_cast<std::uint32_t>(corners.size()), static_cast<std::uint32_t>(polygon.size()), shade,
                        0, twice_signed_area(polygon) > 0.0});
    corners.insert(corners.end(), polygon.begin(), polygon.end());
  }
  // active: the bounds of the iris whose fringes reach the polygon.
  void add(std::span<const Point> polygon, const Shade& shade, const Screened& behind,
           std::span<const std::uint16_t> active) {
    add(polygon, shade);
    screened.push_back(behind);
    screened.back().first = static_cast<std::uint32_t>(bounds.size());
    screened.back().count = static_cast<std::uint32_t>(active.size());
    bounds.insert(bounds.end(), active.begin(), active.end());
    polygons.back().screened = static_cast<std::uint32_t>(screened.size());
  }
  [[nodiscard]] std::uint32_t partner_of(std::size_t corner) const {
    return partner.empty() ? kAlone : partner[corner];
  }
  [[nodiscard]] std::span<const Point> corners_of(const Polygon& p) const {
    return {corners.data() + p.first, p.count};
  }
  [[nodiscard]] std::size_t bytes() const {
    return corners.size() * sizeof(Point) + partner.size() * sizeof(std::uint32_t) + polygons.size() * sizeof(Polygon) +
           screened.size() * sizeof(Screened) + dirt.size() * sizeof(PastDirt);
  }
};

}  // namespace contrejour::inline internal::adaptive
