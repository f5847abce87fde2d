// What is drawn: convex polygons with an irradiance that changes linearly over each, in pixels of the frame.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "contrejour/vec.h"
#include "render/adaptive/edge_table.h"

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
  std::int32_t screened = 0;  // 0: no screen; k + 1: PolygonList::screened[k]; -(k + 1): PolygonList::fringed[k]
};

struct PolygonList {
  // Its irradiance times what a screen lets through, pixel by pixel.
  struct Screened {
    std::shared_ptr<const BandScreen> screen;
    StopMap map;
  };
  // The same for edges' fringes, of a triangle large enough for places in the stop to be linear beyond it.
  struct Fringed {
    const EdgeTable* table;
    Vec2 at_origin, along_x, along_y;  // the place in the stop of the frame's corner, and its change by pixel
    std::uint32_t first = 0, count = 0;  // of bounds: those whose fringes are within
  };

  std::vector<Point> corners;
  std::vector<Polygon> polygons;
  std::vector<Screened> screened;
  std::vector<Fringed> fringed;
  std::vector<std::uint16_t> bounds;
  struct Table {
    std::shared_ptr<const BandScreen> band;
    std::shared_ptr<const EdgeTable> table;
  };
  std::vector<Table> tables;  // that `fringed` reads

  void add(std::span<const Point> polygon, const Shade& shade) {
    polygons.push_back(
        {static_cast<std::uint32_t>(corners.size()), static_cast<std::uint32_t>(polygon.size()), shade, 0});
    corners.insert(corners.end(), polygon.begin(), polygon.end());
  }
  void add(std::span<const Point> polygon, const Shade& shade, Screened screen) {
    add(polygon, shade);
    screened.push_back(std::move(screen));
    polygons.back().screened = static_cast<std::int32_t>(screened.size());
  }
  // active: the bounds of the iris whose fringes are within.
  void add(std::span<const Point> polygon, const Shade& shade, Fringed fringes, std::span<const std::uint16_t> active) {
    add(polygon, shade);
    fringes.first = static_cast<std::uint32_t>(bounds.size());
    fringes.count = static_cast<std::uint32_t>(active.size());
    bounds.insert(bounds.end(), active.begin(), active.end());
    fringed.push_back(fringes);
    polygons.back().screened = -static_cast<std::int32_t>(fringed.size());
  }
  [[nodiscard]] std::span<const Point> corners_of(const Polygon& p) const {
    return {corners.data() + p.first, p.count};
  }
  [[nodiscard]] std::size_t bytes() const {
    return corners.size() * sizeof(Point) + polygons.size() * sizeof(Polygon) + screened.size() * sizeof(Screened) +
           fringed.size() * sizeof(Fringed);
  }
};

}  // namespace contrejour::adaptive
