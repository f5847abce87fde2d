// SPDX-License-Identifier: Apache-2.0
#include "render/reference/pupil_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "aperture/iris_blades.h"
#include "contrejour/expert/iris_field.h"

namespace contrejour::inline internal::reference {
namespace {

constexpr double kFailed = std::numeric_limits<double>::infinity();
constexpr double kUniform = 1e-4;  // a stop pattern this close to 1 all over a cell needs no smaller cells
constexpr double kNoArea = 1e-300;  // pixels; avoids a division by 0
constexpr double kNearObscuration = 1.5;  // radii from an obscuration's edge
constexpr double kNegligible = 0.25;  // fraction of a cut cell's footprint, or of the accuracy of a picture's edge

// A ray from one point of the entrance plane, as far as cells need it.
struct Sample {
  Vec2 entrance_mm;
  Vec2 pixel;
  double transmission = 0.0;
  double blocked = kFailed;  // <= 0 gets through; infinite where the ray failed
  double outside = kFailed;  // as blocked, but for the opening's convex hull and without obscurations
  double obscured = -kFailed;  // how deep within an obscuration, over its radius
  StopCrossings crossed;
  std::array<double, kMaxStopCrossings> distance{};  // for a picture as the iris

  [[nodiscard]] bool traced() const { return blocked < kFailed; }
};

Sample between(const Sample& a, const Sample& b, double t) {
  Sample s{a.entrance_mm + (b.entrance_mm - a.entrance_mm) * t,
           a.pixel + (b.pixel - a.pixel) * t,
           std::lerp(a.transmission, b.transmission, t),
           0.0,
           0.0,
           0.0,
           {},
           {}};
  const StopCrossings &from = a.crossed, &to = b.crossed;
  for (std::size_t c = 0; c < from.stop.size(); ++c) s.crossed.stop[c] = from.stop[c] + (to.stop[c] - from.stop[c]) * t;
  s.crossed.front_mm = from.front_mm + (to.front_mm - from.front_mm) * t;
  return s;
}

// Corners in order around the cell: low-low, high-low, high-high, low-high in entrance x and y.
using Corners = std::array<Sample, 4>;

struct Extent {
  Vec2 low{kFailed, kFailed}, high{-kFailed, -kFailed};

  void add(Vec2 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  [[nodiscard]] double size() const { return std::max(high.x - low.x, high.y - low.y); }
};

class CellWalker {
 public:
  CellWalker(const OpticalPath& path, const Iris& iris, const LightSource& light, double z_mm, const Frame& frame,
             const CellLimits& limits, const LitPolygon& lit, const StopTransmittance& stop,
             const std::function<bool()>& is_unwanted)
      : path_(path), iris_(iris), light_(light), z_mm_(z_mm), frame_(frame), limits_(limits), lit_(lit), stop_(stop),
        is_unwanted_(is_unwanted) {
    if (iris.field) hull_ = iris.field->hull();
  }

  [[nodiscard]] Sample sample(Vec2 entrance_mm) {
    ++counts_.rays;
    Sample s;
    s.entrance_mm = entrance_mm;
    const Vec3 from{entrance_mm.x, entrance_mm.y, z_mm_};
    const TracedRay ray = trace(path_, {from, light_.direction_at(from)});
    if (ray.status != RayStatus::Ok) return s;
    s.pixel = frame_.pixel_from_sensor(ray.sensor_mm);
    s.transmission = ray.transmission * light_.flux_at(from);
    s.blocked = blocked_by(ray, path_, iris_);
    s.outside = s.blocked;
    if (path_.obscured) trace_past_obscurations(ray, s);
    if (iris_.field) sample_picture(ray, s);
    for (std::size_t c = 0; c < ray.stop.size(); ++c) s.crossed.stop[c] = ray.stop[c] * stop_.outer_radius();
    if (stop_.has_front()) s.crossed.front_mm = stop_.dirt->site().front_point(entrance_mm, z_mm_, light_);
    return s;
  }

  void walk(const Corners& corners, int depth) {
    if (ended()) return;
    const Sample middle = sample((corners[0].entrance_mm + corners[2].entrance_mm) * 0.5);
    const Blocking blocking = blocking_of(corners, middle);
    if (!may_be_open(blocking, middle, depth)) return;
    if (is_dark_and_small(corners, blocking)) return;
    if (outside_frame(corners, middle)) return;
    if (pattern_region(corners, middle) == PatternRegion::Dark) return;
    if (depth < limits_.max_depth && needs_cutting(corners, middle, blocking, depth)) {
      cut(corners, middle, depth);
      return;
    }
    for (std::size_t k = 0; k < 4; ++k) emit(corners[k], corners[(k + 1) % 4], middle);
  }

  [[nodiscard]] CellCounts counts() const { return counts_; }

  // Whether the caller wants no more cells. A cell of the first grid may be cut into so small ones that it takes tenths
  // of a second.
  [[nodiscard]] bool ended() {
    constexpr unsigned int kCellsBetweenQuestions = 256;
    if (!has_ended_ && visited_++ % kCellsBetweenQuestions == 0) has_ended_ = is_unwanted_();
    return has_ended_;
  }

 private:
  [[nodiscard]] StopTransmittance::Cell stop_cell(const Corners& corners, const Sample& middle,
                                                  std::array<StopCrossings, 4>& buffer) const {
    for (std::size_t k = 0; k < corners.size(); ++k) buffer[k] = corners[k].crossed;
    return {buffer, middle.crossed, static_cast<std::size_t>(path_.stop_crossings)};
  }
  [[nodiscard]] static bool all_traced(const Corners& corners, const Sample& middle) {
    return middle.traced() && std::ranges::all_of(corners, [](const Sample& s) { return s.traced(); });
  }
  // If a ray has failed, the pattern counts as varying, and the cell as dirty.
  [[nodiscard]] PatternRegion pattern_region(const Corners& corners, const Sample& middle) const {
    if (!stop_.pattern || path_.stop_crossings == 0) return PatternRegion::Uniform;
    if (!all_traced(corners, middle)) return PatternRegion::Varying;
    std::array<StopCrossings, 4> buffer;
    return stop_.region(stop_cell(corners, middle, buffer), kUniform);
  }
  [[nodiscard]] bool is_dirty(const Corners& corners, const Sample& middle) const {
    if (!stop_.dirt) return false;
    if (!all_traced(corners, middle)) return true;
    std::array<StopCrossings, 4> buffer;
    return !stop_.is_clean(stop_cell(corners, middle, buffer));
  }

  // The transmittance of the stop pattern for the open part of a triangle: at the middle of that part, averaged over a
  // square as large as the triangle.
  [[nodiscard]] double pattern_transmittance(const std::array<const Sample*, 3>& triangle,
                                             std::span<const Sample> open) const {
    if (!stop_.pattern) return 1.0;
    const auto crossings = static_cast<std::size_t>(path_.stop_crossings);
    std::array<StopPoint, kMaxStopCrossings> points;
    for (std::size_t c = 0; c < crossings; ++c) {
      const auto at = [&](const Sample& s) { return s.crossed.stop[c]; };
      const Vec2 origin = at(*triangle[0]);
      points[c].width = std::sqrt(0.5 * std::abs(cross(at(*triangle[1]) - origin, at(*triangle[2]) - origin)));
      for (const Sample& s : open) points[c].at = points[c].at + at(s) * (1.0 / static_cast<double>(open.size()));
    }
    return stop_.pattern->transmittance({points.data(), crossings});
  }

  // The transmittance of dirt for the open part of a triangle: the part is split into triangles, and the transmittance
  // is looked up in kParts^2 parts of each.
  [[nodiscard]] double dirt_transmittance(std::span<const Sample> open) const {
    if (!stop_.dirt) return 1.0;
    double transmitted = 0.0, all = 0.0;
    for (std::size_t k = 2; k < open.size(); ++k) {
      const Vec2 origin = open[0].pixel;
      const double area = 0.5 * std::abs(cross(open[k - 1].pixel - origin, open[k].pixel - origin)) + kNoArea;
      all += area;
      const std::array<StopCrossings, 3> triangle{open[0].crossed, open[k - 1].crossed, open[k].crossed};
      double sum = 0.0;
      for (int i = 0; i < kParts; ++i) {
        for (int j = 0; i + j < kParts; ++j) {
          sum += dirt_transmittance(triangle, {i + 1.0 / 3.0, j + 1.0 / 3.0});
          if (i + j + 1 < kParts) sum += dirt_transmittance(triangle, {i + 2.0 / 3.0, j + 2.0 / 3.0});
        }
      }
      transmitted += area * sum / (kParts * kParts);
    }
    return transmitted / all;
  }
  // at: the middle of a part, along two sides.
  static constexpr int kParts = 2;
  [[nodiscard]] double dirt_transmittance(const std::array<StopCrossings, 3>& triangle, Vec2 at) const {
    return stop_.dirt_transmittance(
        {triangle, static_cast<std::size_t>(path_.stop_crossings), at * (1.0 / kParts), 1.0 * kParts * kParts});
  }

  // Bounds of `blocked` over a cell, from its corners and its middle.
  struct Blocking {
    double lowest = kFailed;  // of the rays that did not fail
    double highest = -kFailed;  // of the rays that did not fail
    double lowest_outside = kFailed, highest_outside = -kFailed;
    double slack = 0.0;  // how much it may vary in between, if the opening is not convex
    bool dark = false;  // a picture is dark around here, or all lies within an obscuration
    bool near_obscuration = false;  // part of an obscuration may lie between the samples
    bool some_failed = false;
  };

  void trace_past_obscurations(TracedRay ray, Sample& s) const {
    s.obscured = ray.obscured;
    ray.obscured = -1.0;
    s.outside = blocked_by(ray, path_, iris_);
  }

  // Two samples may lie within different obscurations, or at different sides of one, with light between them. This is
  // the less likely the deeper they lie, and does not matter in small cells.
  void allow_for_obscurations(const Corners& corners, const Sample& middle, Blocking& b) const {
    double smallest = middle.obscured, largest = middle.obscured;
    Extent e;
    for (const Sample& s : corners) {
      if (!s.traced()) return;
      smallest = std::min(smallest, s.obscured);
      largest = std::max(largest, s.obscured);
      e.add(s.pixel);
    }
    const bool small = e.size() < kNegligible * limits_.cut_footprint_px;
    b.dark = b.dark || smallest > (small ? 0.0 : largest - smallest);
    b.near_obscuration = largest > -kNearObscuration;
  }

  void sample_picture(const TracedRay& ray, Sample& s) const {
    s.outside = ray.relative_height - 1.0;
    for (std::size_t c = 0; c < static_cast<std::size_t>(path_.stop_crossings); ++c) {
      s.distance[c] = iris_distance(iris_, ray.stop[c]);
      const Vec2 p = rotated(ray.stop[c], -iris_.rotation_rad);
      for (const IrisBound& bound : hull_) s.outside = std::max(s.outside, bound.distance(p));
    }
  }

  // The distance to an edge changes by no more than the distance moved: at most half of that between the corners that
  // are farthest apart.
  void allow_for_picture(const Corners& corners, Blocking& b) const {
    for (std::size_t c = 0; c < static_cast<std::size_t>(path_.stop_crossings); ++c) {
      double longest = 0.0;
      double nearest = kFailed;
      for (const Sample& p : corners) {
        if (!p.traced()) continue;
        nearest = std::min(nearest, p.distance[c]);
        for (const Sample& q : corners)
          if (q.traced()) longest = std::max(longest, length(p.crossed.stop[c] - q.crossed.stop[c]));
      }
      b.slack = std::max(b.slack, 0.5 * longest);
      b.dark = b.dark || nearest > 0.5 * longest;
    }
  }

  [[nodiscard]] Blocking blocking_of(const Corners& corners, const Sample& middle) const {
    Blocking b;
    if (iris_.field) allow_for_picture(corners, b);
    if (path_.obscured && middle.traced()) allow_for_obscurations(corners, middle, b);
    for (const Sample* s : {&corners[0], &corners[1], &corners[2], &corners[3], &middle}) {
      if (!s->traced()) {
        b.some_failed = true;
        continue;
      }
      b.lowest = std::min(b.lowest, s->blocked);
      b.highest = std::max(b.highest, s->blocked);
      b.lowest_outside = std::min(b.lowest_outside, s->outside);
      b.highest_outside = std::max(b.highest_outside, s->outside);
    }
    return b;
  }

  // A lower bound of `blocked` over the cell shows whether it may be open. `blocked` is the largest of several
  // distances from the axis. If points at the surfaces are linear functions over the cell, these distances are convex
  // functions, and so is their maximum f. For any point p and the opposite point q, f(middle) <= (f(p) + f(q)) / 2, and
  // f(q) is at most the highest corner. Hence f(p) >= 2 f(middle) - highest, however small the pupil is and even if all
  // corners are equal. For the nonlinear part a margin is allowed: the range of the samples, times a factor that halves
  // with each subdivision. A failed ray gives no bound. A picture's opening is not convex: its convex hull is used for
  // this bound, and distances to the picture's edges within it.
  [[nodiscard]] bool may_be_open(const Blocking& b, const Sample& middle, int depth) const {
    if (b.lowest <= 0.0) return true;
    if (b.some_failed) return depth < (b.lowest < kFailed ? limits_.search_depth : limits_.blind_depth);
    if (b.dark) return false;
    if (b.lowest_outside <= 0.0) return true;
    return 2.0 * middle.outside - b.highest_outside <= std::ldexp(b.highest_outside - b.lowest_outside, -depth);
  }

  // A cell between dark parts of a picture, or between an obscuration and a rim, in which no sample gets through and
  // which is too small to matter.
  [[nodiscard]] bool is_dark_and_small(const Corners& corners, const Blocking& b) const {
    if ((!iris_.field && !path_.obscured) || b.some_failed || b.lowest <= 0.0 || b.lowest_outside > 0.0) return false;
    Extent e;
    for (const Sample& s : corners) e.add(s.pixel);
    return e.size() < kNegligible * limits_.cut_footprint_px && b.slack < kNegligible * IrisField::kTolerance;
  }

  // The extent is enlarged by its own size, for light that falls outside the box of the corners.
  [[nodiscard]] bool outside_frame(const Corners& corners, const Sample& middle) const {
    Extent e;
    for (const Sample& s : corners) {
      if (!s.traced()) return false;
      e.add(s.pixel);
    }
    if (!middle.traced()) return false;
    e.add(middle.pixel);
    const double margin = e.size();
    return e.high.x + margin < 0.0 || e.high.y + margin < 0.0 || e.low.x - margin > frame_.width ||
           e.low.y - margin > frame_.height;
  }

  [[nodiscard]] bool needs_cutting(const Corners& corners, const Sample& middle, const Blocking& blocking,
                                   int depth) const {
    if (blocking.lowest > 0.0) return true;  // dark so far, but an opening may be inside
    Extent e;
    Vec2 mean{};
    double mean_blocked = 0.0;
    for (const Sample& s : corners) {
      if (s.traced()) e.add(s.pixel);
      mean = mean + s.pixel * 0.25;
      mean_blocked += s.blocked * 0.25;
    }
    if (blocking.some_failed) {
      if (middle.traced()) e.add(middle.pixel);
      return depth < limits_.search_depth || e.size() > limits_.cut_footprint_px;
    }
    if (e.size() > limits_.pattern_footprint_px && pattern_region(corners, middle) == PatternRegion::Varying)
      return true;
    if (e.size() > limits_.dirt_footprint_px && is_dirty(corners, middle)) return true;
    const bool is_cut = blocking.highest > -blocking.slack;
    const bool is_fine = is_cut || blocking.near_obscuration;
    if (e.size() > (is_fine ? limits_.cut_footprint_px : limits_.footprint_px)) return true;
    // However small its image is, a cell that is cut by an edge must contain a nearly straight piece of it.
    const double bow = std::abs(middle.blocked - mean_blocked);
    if (is_cut && bow > limits_.edge_sag * (blocking.highest - blocking.lowest)) return true;
    return length(middle.pixel - mean) > limits_.sag_px;
  }

  void cut(const Corners& c, const Sample& middle, int depth) {
    const auto half = [&](std::size_t a, std::size_t b) { return sample((c[a].entrance_mm + c[b].entrance_mm) * 0.5); };
    const Sample south = half(0, 1);
    const Sample east = half(1, 2);
    const Sample north = half(2, 3);
    const Sample west = half(3, 0);
    walk({c[0], south, middle, west}, depth + 1);
    walk({south, c[1], east, middle}, depth + 1);
    walk({middle, east, c[2], north}, depth + 1);
    walk({west, middle, north, c[3]}, depth + 1);
  }

  // The part of a triangle where the linear interpolation of `blocked` is <= 0.
  void emit(const Sample& a, const Sample& b, const Sample& c) {
    if (!a.traced() || !b.traced() || !c.traced()) return;
    const std::array<const Sample*, 3> in{&a, &b, &c};
    std::array<Sample, 4> open;
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Sample& p = *in[k];
      const Sample& q = *in[(k + 1) % 3];
      if (p.blocked <= 0.0) open[count++] = p;
      if ((p.blocked <= 0.0) != (q.blocked <= 0.0)) open[count++] = between(p, q, p.blocked / (p.blocked - q.blocked));
    }
    if (count < 3) return;
    std::array<Vec2, 4> pixels;
    double twice_area = 0.0;
    double transmission = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      pixels[k] = open[k].pixel;
      transmission += open[k].transmission / static_cast<double>(count);
      if (k + 1 < count && k > 0) {
        twice_area += cross(open[k].entrance_mm - open[0].entrance_mm, open[k + 1].entrance_mm - open[0].entrance_mm);
      }
    }
    ++counts_.polygons;
    const double passed = pattern_transmittance(in, {open.data(), count}) * dirt_transmittance({open.data(), count});
    lit_({pixels.data(), count}, 0.5 * std::abs(twice_area) * transmission * light_.shared_flux() * passed);
  }

  const OpticalPath& path_;
  const Iris& iris_;
  LightSource light_;
  double z_mm_;
  const Frame& frame_;
  CellLimits limits_;
  const LitPolygon& lit_;
  const StopTransmittance& stop_;
  std::vector<IrisBound> hull_;  // of a picture's opening
  CellCounts counts_;
  const std::function<bool()>& is_unwanted_;
  unsigned int visited_ = 0;
  bool has_ended_ = false;
};

}  // namespace

CellLimits CellLimits::for_density(double density) {
  CellLimits limits;
  limits.root_cells = std::max(8, static_cast<int>(std::lround(limits.root_cells * density)));
  limits.footprint_px /= density;
  limits.pattern_footprint_px /= density;
  limits.dirt_footprint_px /= density;
  limits.cut_footprint_px /= density;
  limits.sag_px /= density;
  limits.edge_sag /= density;
  return limits;
}

CellCounts for_each_lit_polygon(const OpticalPath& path, const Iris& iris, const LightSource& light,
                                const EntranceWindow& window, const Frame& frame, const CellLimits& limits,
                                const std::function<bool()>& stop, const LitPolygon& lit,
                                const StopTransmittance& transmittance) {
  CellWalker walker(path, iris, light, window.z_mm, frame, limits, lit, transmittance, stop);
  const int n = limits.root_cells;
  const auto row_of = [&](int iy) {
    std::vector<Sample> row;
    for (int ix = 0; ix <= n; ++ix) {
      row.push_back(walker.sample({std::lerp(window.min_mm.x, window.max_mm.x, static_cast<double>(ix) / n),
                                   std::lerp(window.min_mm.y, window.max_mm.y, static_cast<double>(iy) / n)}));
    }
    return row;
  };
  std::vector<Sample> below = row_of(0);
  for (int iy = 0; iy < n && !stop(); ++iy) {
    std::vector<Sample> above = row_of(iy + 1);
    for (std::size_t ix = 0; ix < static_cast<std::size_t>(n); ++ix) {
      walker.walk({below[ix], below[ix + 1], above[ix + 1], above[ix]}, 0);
    }
    below = std::move(above);
  }
  return walker.counts();
}

}  // namespace contrejour::inline internal::reference
