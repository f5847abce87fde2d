// SPDX-License-Identifier: Apache-2.0
// Clips the shadows of dirt's shapes on a polygon to polygons: each with the light that a shape takes of what earlier
// shapes left. A renderer that adds up polygons draws them as light of negative sign: exactly, and for the cost of
// their outlines. Accuracy: points in the dirt's plane are taken as linear in the polygon's coordinates; outlines are
// off by a 50th of `finest_mm`, with the right areas. Thread-safety: one object a thread.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "render/planning/dirt_field.h"

namespace contrejour::inline internal::stop_patterns {

// The map from a polygon's coordinates (pixels, for example) to the plane of the dirt, in mm.
struct PlaneView {
  Vec2 origin, along_x, along_y;

  [[nodiscard]] Vec2 at(Vec2 p) const { return origin + along_x * p.x + along_y * p.y; }
  // Determines the map from three points that do not lie on a line.
  [[nodiscard]] static PlaneView through(std::span<const Vec2, 3> points, std::span<const Vec2, 3> points_mm);
};

class ShadowClipper {
 public:
  using Shadow = std::function<void(std::span<const Vec2> polygon, double blocked)>;

  // Calls visit(convex polygon, fraction of the polygon's light that is lost there); the fractions add up. crossings:
  // one view for each time that the light crosses the dirt's plane. polygon: convex. finest_mm: the size of the
  // smallest visible detail.
  void for_each(const DirtField& dirt, std::span<const PlaneView> crossings, std::span<const Vec2> polygon,
                double finest_mm, const Shadow& visit);

 private:
  using Polygon = std::vector<Vec2>;
  struct Box {
    Vec2 low, high;
    [[nodiscard]] bool meets(const Box& o) const {
      return low.x < o.high.x && o.low.x < high.x && low.y < o.high.y && o.low.y < high.y;
    }
  };
  // A convex part of a shape, clipped to the polygon, in its coordinates.
  struct Part {
    std::uint64_t shape = 0;  // its index and crossing
    double opacity = 1.0;
    Polygon outline;
    Box box;
  };
  struct Piece {
    Polygon outline;
    double blocked = 0.0;
  };
  static Box box_of(std::span<const Vec2> polygon);
  void find_parts(const DirtField& dirt, std::span<const PlaneView> crossings, double finest_mm);
  void cut(const DirtField& dirt, std::span<const PlaneView> crossings, double finest_mm, int depth,
           const Shadow& visit);
  void add_parts(const DirtStroke& stroke, std::uint64_t shape, const PlaneView& view, double finest_mm);
  void add_part(const DirtStroke& stroke, std::uint64_t shape, const PlaneView& view);
  void subtract_earlier_shapes(std::size_t part);
  bool clip_by(const Part& other, Piece piece, std::vector<Piece>& out);

  Polygon region_, outline_, scratch_, inside_;
  std::vector<Part> parts_;
  std::vector<Piece> pieces_, next_;
  std::vector<std::uint32_t> found_;
};

}  // namespace contrejour::inline internal::stop_patterns
