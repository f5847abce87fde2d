// SPDX-License-Identifier: Apache-2.0
// Clips a cell's outline along arcs and lines: to what the iris and the rims leave open.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "ghosts/iris_shape.h"
#include "render/adaptive/clip/isoparametric_cell.h"

namespace contrejour::inline internal::adaptive {

class PolygonClipper {
 public:
  explicit PolygonClipper(const IrisShape& iris) : iris_(iris) {}

  // whole: the cell's four corners at uv (0, 0), (1, 0), (1, 1), (0, 1); or the first three of them; or the four, each
  // followed by the middle of the next side. They define the values between them. outline: the same corners, and others
  // on the sides between them. Arcs get a corner every arc_step_rad / sqrt(r) at least, with r their radius in stop
  // radii. The result is empty if nothing is open, and valid until the next call, as long as `whole` is.
  [[nodiscard]] std::span<const Corner> open_part(std::span<const Corner> whole, std::span<const Corner> outline,
                                                  int crossings, int rims, double arc_step_rad);

  // The same without the iris.
  [[nodiscard]] std::span<const Corner> within_rims(std::span<const Corner> whole, std::span<const Corner> outline,
                                                    int crossings, int rims);

  // The same for a picture as the iris: visits convex parts that do not overlap, each with its transmittance. Details
  // are resolved down to the fraction `finest` of the cell's extent in the stop's plane.
  using OpenPart = std::function<void(std::span<const Corner> part, double open)>;
  void for_each_open_part(std::span<const Corner> whole, int crossings, int rims, double finest, const OpenPart& visit);

 private:
  // A circle in the plane of a crossing, whose two coordinates are a corner's from `limit` on.
  struct Circle {
    std::size_t limit = 0;
    Vec2 centre;
    double radius = 1.0;

    [[nodiscard]] Vec2 unit_from_stop(const Corner& c) const {
      return (Vec2{c.limit[limit], c.limit[limit + 1]} - centre) * (1.0 / radius);
    }
    [[nodiscard]] Vec2 stop_from_unit(Vec2 p) const { return centre + p * radius; }
  };

  void start_with(std::span<const Corner> whole, std::span<const Corner> outline, int crossings, int rims);
  void clip_by_iris(std::size_t limit);
  void clip_by_rims(int crossings, int rims);
  void clip_by_pieces(std::size_t limit, std::size_t first_rim, double finest, double open, const OpenPart& visit);
  void clip_by_line(std::size_t limit, const IrisBound& bound);
  void clip_by_circle(const Circle& circle);
  template <class Value>
  void clip_where_positive(Value value);
  template <class Value>
  void curve_cuts(Value value);
  void add_arc(const Circle& circle, Vec2 from, double angle, Vec2 near_uv);
  void add_circle(const Circle& circle, double orientation);
  void add_corners(const Circle& circle, Vec2 first, double step, int count, Vec2 near_uv);
  [[nodiscard]] bool is_inside(std::size_t limit, const IrisBound& half_plane) const;
  [[nodiscard]] double width_in_stop() const;
  [[nodiscard]] double step_on(const Circle& circle) const;
  [[nodiscard]] bool surrounds_centre(const Circle& circle) const;
  [[nodiscard]] Corner between(const Corner& a, const Corner& b, double t) const;

  const IrisShape& iris_;
  IsoparametricCell cell_;
  double arc_step_ = 0.1;  // radians
  int cuts_ = 0, arcs_ = 0;  // bounds that have clipped the cell, and the circles among them
  std::vector<Corner> polygon_, next_;
  std::vector<std::size_t> exits_;  // indices in next_ at which the outline leaves the circle
  std::vector<Vec2> arc_;  // points in the stop
};

}  // namespace contrejour::inline internal::adaptive
