// SPDX-License-Identifier: Apache-2.0
// A uniform grid of a light's rays over a rectangle of the entrance plane, traced along one path; hullin2011
// 4.1. Every vertex keeps the values that are interpolated over cells: sensor point, transmission, relative_height and
// stop coordinates.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "contrejour/context.h"
#include "ghosts/iris_shape.h"
#include "ghosts/light_frame.h"
#include "optics/trace/packet_trace.h"

namespace contrejour::inline internal {

struct Rectangle {
  Vec2 low, high;
  friend bool operator==(const Rectangle&, const Rectangle&) = default;
};

[[nodiscard]] inline double area_of(const Rectangle& r) { return (r.high.x - r.low.x) * (r.high.y - r.low.y); }

// The smallest rectangle that contains both.
[[nodiscard]] inline Rectangle both(const Rectangle& a, const Rectangle& b) {
  return {{std::min(a.low.x, b.low.x), std::min(a.low.y, b.low.y)},
          {std::max(a.high.x, b.high.x), std::max(a.high.y, b.high.y)}};
}
// The mirror image about y = 0.
[[nodiscard]] inline Rectangle mirrored(const Rectangle& r) { return {{r.low.x, -r.high.y}, {r.high.x, -r.low.y}}; }

// Buffers are kept between passes; one object a thread.
class RayGrid {
 public:
  // box: on the plane z = z_mm of the entrance window, in mm.
  void trace(const OpticalPath& path, const ReflectanceTables& tables, const IrisShape& iris, const LightSource& light,
             double z_mm, const Rectangle& box, int side, PacketPrecision precision);

  // The same for a prepared path of the light from any point of the plane. Once the context is cancelled, values may be
  // those of earlier grids; null: never.
  void trace(PacketPath& packets, const IrisShape& iris, const Rectangle& box, int side, PacketPrecision precision,
             const Context* context = nullptr);

  // The same for a light in the x-z plane and a box that is symmetric in y: one half is traced and mirrored
  // (hullin2011 4.2, mirror symmetry), the iris is applied to every ray at its crossings. Returns the number of rays
  // traced.
  std::size_t trace_mirrored(const OpticalPath& path, const ReflectanceTables& tables, const IrisShape& iris,
                             const LightSource& light, double z_mm, const Rectangle& box, int side,
                             PacketPrecision precision);

  // The same for a prepared path and a light in its own frame: mirrored if the light and the box are symmetric in y;
  // sensor points and stop coordinates are rotated to the lens's frame.
  std::size_t trace(PacketPath& packets, const IrisShape& iris, const LightFrame& light, const Rectangle& box, int side,
                    PacketPrecision precision);

  // The same for rays through any points, relative to an origin: one row, no grid.
  void trace_points(PacketPath& packets, const IrisShape& iris, const LightFrame& light, Vec2 origin_mm,
                    std::span<const float> x_mm, std::span<const float> y_mm, PacketPrecision precision);

  // Divides every cell into factor x factor, by cubics through the rays along each axis, for fields that few rays
  // resolve. The grid needs at least four rays a side, all of which arrive; sensor points are discarded.
  void refine(const IrisShape& iris, int factor);

  // Turns the sensor points about the axis; the crossings of the stop stay as they are.
  void rotate_sensor(double angle_rad);

  [[nodiscard]] int side() const { return side_; }
  [[nodiscard]] int cells() const { return side_ - 1; }
  [[nodiscard]] int stop_crossings() const { return stop_crossings_; }
  [[nodiscard]] const Rectangle& box() const { return box_; }
  [[nodiscard]] Vec2 step_mm() const;
  [[nodiscard]] std::size_t at(int ix, int iy) const {
    return static_cast<std::size_t>(iy) * static_cast<std::size_t>(side_) + static_cast<std::size_t>(ix);
  }
  // The four vertices of a cell in order.
  [[nodiscard]] std::array<std::size_t, 4> corners(int ix, int iy) const {
    return {at(ix, iy), at(ix + 1, iy), at(ix + 1, iy + 1), at(ix, iy + 1)};
  }

  // The largest distance, in stop radii, of the stop coordinates of a ray between these corners from the nearest
  // corner's: `blocked` may differ from the corner's by that much. 0 for a convex opening, where the corners bound the
  // values between them.
  [[nodiscard]] float slack(std::span<const std::size_t> corners) const;

  // True if an obscuration blocks light: open corners then do not imply that light passes between them.
  [[nodiscard]] bool is_obscured() const { return obscured_; }

  // One value a vertex. A ray that failed has blocked = infinity.
  std::vector<float> sensor_x_mm, sensor_y_mm, transmission, relative_height;
  std::array<std::vector<float>, kMaxStopCrossings> stop_x, stop_y, iris_distance;
  std::vector<float> blocked;  // the largest of relative_height - 1 and the iris distances

 private:
  void resize(std::size_t count);
  void resize_light(std::size_t count);
  void prepare(const PacketPath& packets, std::size_t count);
  void trace_packets_of(const PacketPath& packets, const float* x_mm, const float* y_mm, std::size_t first,
                        std::size_t count, PacketPrecision precision);
  void to_lens_frame(const IrisShape& iris, const LightFrame& light);
  void trace_rows(const PacketPath& packets, const Rectangle& box, int side, int rows, PacketPrecision precision,
                  const Context* context = nullptr);
  void mirror_rows(int from);
  void refine(std::vector<float>& values, int factor) const;
  void find_blocked(const IrisShape& iris, std::size_t count);

  int side_ = 0;
  int stop_crossings_ = 0;
  bool convex_ = true;
  bool obscured_ = false;
  Rectangle box_;
  std::vector<float> x_mm_, y_mm_;  // entrance points from box_.low
};

// The precision for fluxes, which need open fractions of cells and no sensor points: float, unless the pupil is tiny.
[[nodiscard]] PacketPrecision flux_precision(const Rectangle& pupil);

// Chooses float or double so that the rounding of neighbouring rays is far below their distance on the sensor.
[[nodiscard]] PacketPrecision precision_for(const OpticalPath& path, const ReflectanceTables& tables,
                                            const LightSource& light, double z_mm, const Rectangle& box, int side,
                                            double pixel_pitch_mm);

}  // namespace contrejour::inline internal
