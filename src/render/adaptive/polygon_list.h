// What is drawn: convex polygons with an irradiance that changes linearly over each, in pixels of the frame.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "contrejour/vec.h"

namespace contrejour::adaptive {

struct Point {
  float x = 0, y = 0;
};

// Pixel value per pixel area, per channel: at a point, and its change along x and y.
struct Shade {
  Point at;
  std::array<float, 3> value{}, along_x{}, along_y{};
};

struct Polygon {
  std::uint32_t first = 0;  // into PolygonList::corners
  std::uint32_t count = 0;  // 1: a point that carries shade.value
  Shade shade;
};

struct PolygonList {
  std::vector<Point> corners;
  std::vector<Polygon> polygons;

  void add(std::span<const Point> polygon, const Shade& shade) {
    polygons.push_back({static_cast<std::uint32_t>(corners.size()), static_cast<std::uint32_t>(polygon.size()), shade});
    corners.insert(corners.end(), polygon.begin(), polygon.end());
  }
  [[nodiscard]] std::span<const Point> corners_of(const Polygon& p) const {
    return {corners.data() + p.first, p.count};
  }
  [[nodiscard]] std::size_t bytes() const { return corners.size() * sizeof(Point) + polygons.size() * sizeof(Polygon); }
};

}  // namespace contrejour::adaptive
