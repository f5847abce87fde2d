// SPDX-License-Identifier: Apache-2.0
#include "ghosts/ray_grid.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal {
namespace {

// Rounding between neighbours may be this fraction of their distance: it is the ripple of a flat ghost.
constexpr double kMaxRounding = 1e-3;
// Below this number of pixels only a cell's flux is visible, not its shape.
constexpr double kNegligibleCell_px = 0.25;
constexpr int kProbeRays = 64;
constexpr double kFloatPupil_mm = 1.0;
// Rays traced between two looks at whether the caller has cancelled, some hundredths of a second. A multiple of a
// packet's rays, so that packets are the same without looks.
constexpr std::size_t kRaysAtOnce = 32768;

// The cubic through f(0) to f(3), at t.
std::array<float, 4> cubic_weights(double t) {
  return {static_cast<float>(-(t - 1.0) * (t - 2.0) * (t - 3.0) / 6.0),
          static_cast<float>(t * (t - 2.0) * (t - 3.0) / 2.0), static_cast<float>(-t * (t - 1.0) * (t - 3.0) / 2.0),
          static_cast<float>(t * (t - 1.0) * (t - 2.0) / 6.0)};
}

// For each of factor * (side - 1) + 1 points along an axis, the first of the four rays about it and their weights.
struct CubicPoint {
  std::size_t first = 0;
  std::array<float, 4> weight{};
};

std::vector<CubicPoint> cubic_points(int side, int factor) {
  std::vector<CubicPoint> points;
  for (int k = 0; k <= factor * (side - 1); ++k) {
    const int first = std::clamp(k / factor - 1, 0, side - 4);
    points.push_back({static_cast<std::size_t>(first), cubic_weights(static_cast<double>(k) / factor - first)});
  }
  return points;
}

// Rotates vectors about the axis.
void rotate(double cosine, double sine, std::vector<float>& x, std::vector<float>& y) {
  const auto c = static_cast<float>(cosine), s = static_cast<float>(sine);
  for (std::size_t k = 0; k < x.size(); ++k) {
    const float along = x[k], across = y[k];
    x[k] = c * along - s * across;
    y[k] = s * along + c * across;
  }
}

}  // namespace

Vec2 RayGrid::step_mm() const { return (box_.high - box_.low) * (1.0 / (side_ - 1)); }

void RayGrid::resize(std::size_t count) {
  for (auto* v : {&sensor_x_mm, &sensor_y_mm, &x_mm_, &y_mm_}) v->resize(count);
  resize_light(count);
}

void RayGrid::resize_light(std::size_t count) {
  for (auto* v : {&transmission, &relative_height, &blocked}) v->resize(count);
  for (std::size_t c = 0; c < static_cast<std::size_t>(stop_crossings_); ++c) {
    for (auto* v : {&stop_x[c], &stop_y[c], &iris_distance[c]}) v->resize(count);
  }
}

void RayGrid::prepare(const PacketPath& packets, std::size_t count) {
  stop_crossings_ = packets.stop_crossings();
  obscured_ = std::ranges::any_of(packets.steps(), &PacketStep::blocks_within);
  resize(count);
}

// Traces `count` rays, whose values are kept from `first` on.
void RayGrid::trace_packets_of(const PacketPath& packets, const float* x_mm, const float* y_mm, std::size_t first,
                               std::size_t count, PacketPrecision precision) {
  TracedArrays out{sensor_x_mm.data() + first,
                   sensor_y_mm.data() + first,
                   transmission.data() + first,
                   relative_height.data() + first,
                   {},
                   {},
                   nullptr,
                   0};
  for (std::size_t c = 0; c < static_cast<std::size_t>(stop_crossings_); ++c) {
    out.stop_x[c] = stop_x[c].data() + first;
    out.stop_y[c] = stop_y[c].data() + first;
  }
  trace_packets(packets, precision, x_mm, y_mm, count, out);
}

// Traces the first rows of the grid; all arrays are sized for the whole.
void RayGrid::trace_rows(const PacketPath& packets, const Rectangle& box, int side, int rows, PacketPrecision precision,
                         const Context* context) {
  side_ = side;
  box_ = box;
  prepare(packets, at(0, side));
  const Vec2 step = step_mm();
  for (int iy = 0; iy < rows; ++iy) {
    std::fill_n(y_mm_.begin() + static_cast<std::ptrdiff_t>(at(0, iy)), side, static_cast<float>(iy * step.y));
    for (int ix = 0; ix < side; ++ix) x_mm_[at(ix, iy)] = static_cast<float>(ix * step.x);
  }
  const std::size_t count = at(0, rows);
  const std::size_t at_once = context == nullptr ? count : kRaysAtOnce;
  for (std::size_t first = 0; first < count; first += at_once) {
    if (context != nullptr && context->cancelled()) return;
    trace_packets_of(packets, x_mm_.data() + first, y_mm_.data() + first, first, std::min(at_once, count - first),
                     precision);
  }
}

void RayGrid::trace(const OpticalPath& path, const ReflectanceTables& tables, const IrisShape& iris,
                    const LightSource& light, double z_mm, const Rectangle& box, int side, PacketPrecision precision) {
  PacketPath packets(path, tables, {{0.0, 0.0, z_mm}, light});
  trace(packets, iris, box, side, precision);
}

void RayGrid::trace(PacketPath& packets, const IrisShape& iris, const Rectangle& box, int side,
                    PacketPrecision precision, const Context* context) {
  packets.start_from(box.low);
  trace_rows(packets, box, side, side, precision, context);
  if (context != nullptr && context->cancelled()) return;
  find_blocked(iris, at(0, side));
}

std::size_t RayGrid::trace_mirrored(const OpticalPath& path, const ReflectanceTables& tables, const IrisShape& iris,
                                    const LightSource& light, double z_mm, const Rectangle& box, int side,
                                    PacketPrecision precision) {
  const int rows = (side + 1) / 2;
  trace_rows({path, tables, {{box.low.x, box.low.y, z_mm}, light}}, box, side, rows, precision);
  mirror_rows(rows);
  find_blocked(iris, at(0, side));
  return at(0, rows);
}

std::size_t RayGrid::trace(PacketPath& packets, const IrisShape& iris, const LightFrame& light, const Rectangle& box,
                           int side, PacketPrecision precision) {
  const int rows = light.symmetric && box.low.y == -box.high.y ? (side + 1) / 2 : side;
  packets.start_from(box.low);
  trace_rows(packets, box, side, rows, precision);
  mirror_rows(rows);
  to_lens_frame(iris, light);
  return at(0, rows);
}

void RayGrid::trace_points(PacketPath& packets, const IrisShape& iris, const LightFrame& light, Vec2 origin_mm,
                           std::span<const float> x_mm, std::span<const float> y_mm, PacketPrecision precision) {
  side_ = 0;
  prepare(packets, x_mm.size());
  packets.start_from(origin_mm);
  trace_packets_of(packets, x_mm.data(), y_mm.data(), 0, x_mm.size(), precision);
  to_lens_frame(iris, light);
}

// Rotates the results from a light's own frame to the lens's.
void RayGrid::to_lens_frame(const IrisShape& iris, const LightFrame& light) {
  rotate(light.cos_rotation, light.sin_rotation, sensor_x_mm, sensor_y_mm);
  for (std::size_t c = 0; c < static_cast<std::size_t>(stop_crossings_); ++c)
    rotate(light.cos_rotation, light.sin_rotation, stop_x[c], stop_y[c]);
  find_blocked(iris, blocked.size());
}

// Fills the mirrored rows: y coordinates change their sign, other values are copied.
void RayGrid::mirror_rows(int from) {
  const auto mirror = [&](std::vector<float>& values, float sign) {
    for (int iy = from; iy < side_; ++iy) {
      const float* source = values.data() + at(0, side_ - 1 - iy);
      float* target = values.data() + at(0, iy);
      for (int ix = 0; ix < side_; ++ix) target[ix] = sign * source[ix];
    }
  };
  for (auto* same : {&sensor_x_mm, &transmission, &relative_height}) mirror(*same, 1.0F);
  mirror(sensor_y_mm, -1.0F);
  for (std::size_t c = 0; c < static_cast<std::size_t>(stop_crossings_); ++c) {
    mirror(stop_x[c], 1.0F);
    mirror(stop_y[c], -1.0F);
  }
}

void RayGrid::refine(const IrisShape& iris, int factor) {
  sensor_x_mm.clear();
  sensor_y_mm.clear();
  for (auto* v : {&transmission, &relative_height}) refine(*v, factor);
  for (std::size_t c = 0; c < static_cast<std::size_t>(stop_crossings_); ++c) {
    for (auto* v : {&stop_x[c], &stop_y[c]}) refine(*v, factor);
  }
  side_ = factor * (side_ - 1) + 1;
  const std::size_t count = at(0, side_);
  resize_light(count);
  find_blocked(iris, count);
}

void RayGrid::refine(std::vector<float>& values, int factor) const {
  const auto points = cubic_points(side_, factor);
  const auto coarse = static_cast<std::size_t>(side_);
  const std::size_t fine = points.size();
  std::vector<float> rows(coarse * fine);
  for (std::size_t y = 0; y < coarse; ++y) {
    for (std::size_t x = 0; x < fine; ++x) {
      const float* from = values.data() + y * coarse + points[x].first;
      const auto& w = points[x].weight;
      rows[y * fine + x] = w[0] * from[0] + w[1] * from[1] + w[2] * from[2] + w[3] * from[3];
    }
  }
  values.resize(fine * fine);
  for (std::size_t y = 0; y < fine; ++y) {
    const float* from = rows.data() + points[y].first * fine;
    const auto& w = points[y].weight;
    for (std::size_t x = 0; x < fine; ++x) {
      values[y * fine + x] =
          w[0] * from[x] + w[1] * from[fine + x] + w[2] * from[2 * fine + x] + w[3] * from[3 * fine + x];
    }
  }
}

void RayGrid::rotate_sensor(double angle_rad) {
  rotate(std::cos(angle_rad), std::sin(angle_rad), sensor_x_mm, sensor_y_mm);
}

float RayGrid::slack(std::span<const std::size_t> corners) const {
  float longest = 0.0F;
  for (std::size_t c = 0; !convex_ && c < static_cast<std::size_t>(stop_crossings_); ++c) {
    for (const std::size_t a : corners) {
      for (const std::size_t b : corners) {
        const float dx = stop_x[c][a] - stop_x[c][b];
        const float dy = stop_y[c][a] - stop_y[c][b];
        longest = std::max(longest, dx * dx + dy * dy);
      }
    }
  }
  return 0.5F * std::sqrt(longest);
}

void RayGrid::find_blocked(const IrisShape& iris, std::size_t count) {
  convex_ = !iris.is_picture();
  for (std::size_t k = 0; k < count; ++k) blocked[k] = relative_height[k] - 1.0F;
  for (std::size_t c = 0; c < static_cast<std::size_t>(stop_crossings_); ++c) {
    iris.distances(stop_x[c].data(), stop_y[c].data(), count, iris_distance[c].data());
    // In this order a failed ray's NaN never replaces its infinity.
    for (std::size_t k = 0; k < count; ++k) {
      blocked[k] = iris_distance[c][k] > blocked[k] ? iris_distance[c][k] : blocked[k];
    }
  }
}

PacketPrecision flux_precision(const Rectangle& pupil) {
  const Vec2 size = pupil.high - pupil.low;
  return std::min(size.x, size.y) > kFloatPupil_mm ? PacketPrecision::Float : PacketPrecision::Double;
}

// The middle row is traced in both precisions. Variations of the difference from ray to ray are rounding errors; slow
// variations distort the ghost invisibly.
PacketPrecision precision_for(const OpticalPath& path, const ReflectanceTables& tables, const LightSource& light,
                              double z_mm, const Rectangle& box, int side, double pixel_pitch_mm) {
  const PacketPath packets(path, tables, {{box.low.x, 0.5 * (box.low.y + box.high.y), z_mm}, light});
  using Row = std::array<float, kProbeRays>;
  Row x_mm{}, y_mm{};
  const double step_mm = (box.high.x - box.low.x) / (side - 1);
  const double first = 0.5 * ((side - 1) - (kProbeRays - 1));
  for (int k = 0; k < kProbeRays; ++k) x_mm[static_cast<std::size_t>(k)] = static_cast<float>((first + k) * step_mm);
  std::array<std::array<Row, 4 + 2 * kMaxStopCrossings>, 2> rows;
  for (const PacketPrecision precision : {PacketPrecision::Float, PacketPrecision::Double}) {
    auto& row = rows[precision == PacketPrecision::Double ? 1 : 0];
    trace_packets(packets, precision, x_mm.data(), y_mm.data(), kProbeRays,
                  {row[0].data(),
                   row[1].data(),
                   row[2].data(),
                   row[3].data(),
                   {row[4].data(), row[5].data(), row[6].data()},
                   {row[7].data(), row[8].data(), row[9].data()},
                   nullptr,
                   0});
  }
  double noise = 0.0;
  double distance = 0.0;
  for (std::size_t k = 1; k < kProbeRays; ++k) {
    if (!(rows[0][3][k] + rows[0][3][k - 1] + rows[1][3][k] + rows[1][3][k - 1] < 1e9F)) continue;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double exact = rows[1][axis][k] - rows[1][axis][k - 1];
      const double rounded = rows[0][axis][k] - rows[0][axis][k - 1];
      distance += exact * exact;
      noise += (rounded - exact) * (rounded - exact);
    }
  }
  const double negligible_mm = kNegligibleCell_px * pixel_pitch_mm;
  const bool resolved = distance > negligible_mm * negligible_mm * kProbeRays;
  return resolved && noise > kMaxRounding * kMaxRounding * distance ? PacketPrecision::Double : PacketPrecision::Float;
}

}  // namespace contrejour::inline internal
