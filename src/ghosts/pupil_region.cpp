#include "ghosts/pupil_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace contrejour {
namespace {

constexpr int kSearchCells = 32;  // a side, of each zoom step
// Where the first grid meets nothing a finer one follows: a fisheye lets some ghosts through a thousandth of
// its front.
constexpr std::array kFirstCells{kSearchCells, 160};
constexpr int kSearchSteps = 8;
constexpr double kShrinkEnough = 0.6;  // zoom on while the area still falls below this share

struct Sample {
  TracedRay ray;
  Vec2 point_mm;
  double blocked = std::numeric_limits<double>::infinity();  // infinite where the ray failed
};

std::vector<Sample> trace_grid(const OpticalPath& path, const Iris& iris, Vec3 direction, double z_mm,
                               const PupilBox& box, int cells) {
  std::vector<Sample> samples;
  samples.reserve(static_cast<std::size_t>(cells + 1) * static_cast<std::size_t>(cells + 1));
  for (int iy = 0; iy <= cells; ++iy) {
    for (int ix = 0; ix <= cells; ++ix) {
      Sample s;
      s.point_mm = {std::lerp(box.min_mm.x, box.max_mm.x, static_cast<double>(ix) / cells),
                    std::lerp(box.min_mm.y, box.max_mm.y, static_cast<double>(iy) / cells)};
      s.ray = trace(path, {{s.point_mm.x, s.point_mm.y, z_mm}, direction});
      if (s.ray.status == RayStatus::Ok) s.blocked = blocked_by(s.ray, path, iris);
      samples.push_back(s);
    }
  }
  return samples;
}

// Could the cell hold an open point? Its `blocked` function is nearly linear over a cell, so it cannot fall
// below the lowest corner by more than the corners differ. A failed corner tells nothing: the rest decide.
bool may_be_open(const std::array<const Sample*, 4>& corners) {
  double lowest = std::numeric_limits<double>::infinity();
  double highest = -lowest;
  for (const Sample* s : corners) {
    if (!std::isfinite(s->blocked)) continue;
    lowest = std::min(lowest, s->blocked);
    highest = std::max(highest, s->blocked);
  }
  return lowest <= highest - lowest || lowest <= 0.0;
}

std::array<const Sample*, 4> corners_of(const std::vector<Sample>& samples, int cells, int ix, int iy) {
  const auto at = [&](int x, int y) {
    return &samples[static_cast<std::size_t>(y) * static_cast<std::size_t>(cells + 1) + static_cast<std::size_t>(x)];
  };
  return {at(ix, iy), at(ix + 1, iy), at(ix + 1, iy + 1), at(ix, iy + 1)};
}

std::optional<PupilBox> open_box(const std::vector<Sample>& samples, int cells) {
  std::optional<PupilBox> box;
  for (int iy = 0; iy < cells; ++iy) {
    for (int ix = 0; ix < cells; ++ix) {
      const auto corners = corners_of(samples, cells, ix, iy);
      if (!may_be_open(corners)) continue;
      const Vec2 low = corners[0]->point_mm;
      const Vec2 high = corners[2]->point_mm;
      if (!box) box = PupilBox{low, high};
      box->min_mm = {std::min(box->min_mm.x, low.x), std::min(box->min_mm.y, low.y)};
      box->max_mm = {std::max(box->max_mm.x, high.x), std::max(box->max_mm.y, high.y)};
    }
  }
  return box;
}

double area(const PupilBox& box) {
  return (box.max_mm.x - box.min_mm.x) * (box.max_mm.y - box.min_mm.y);
}

// Share of a triangle where a function that is linear over it is <= 0.
double share_below_zero(double a, double b, double c) {
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  if (c <= 0.0) return 1.0;
  if (a > 0.0) return 0.0;
  if (b > 0.0) return a / (a - b) * (a / (a - c));   // the corner at a
  return 1.0 - c / (c - a) * (c / (c - b));          // all but the corner at c
}

}  // namespace

std::optional<PupilBox> find_pupil(const OpticalPath& path, const Iris& iris, Vec3 direction,
                                   const EntranceWindow& window) {
  const auto search = [&](const PupilBox& box, int cells) {
    return open_box(trace_grid(path, iris, direction, window.z_mm, box, cells), cells);
  };
  const PupilBox whole{window.min_mm, window.max_mm};
  std::optional<PupilBox> box;
  for (const int cells : kFirstCells) {
    box = search(whole, cells);
    if (box) break;
  }
  double before = area(whole);
  for (int step = 1; box && step < kSearchSteps && area(*box) < kShrinkEnough * before; ++step) {
    before = area(*box);
    box = search(*box, kSearchCells);
  }
  return box;
}

void for_each_open_triangle(const OpticalPath& path, const Iris& iris, Vec3 direction, double z_mm,
                            const PupilBox& box, int cells, const std::function<void(const PupilTriangle&)>& visit) {
  const auto samples = trace_grid(path, iris, direction, z_mm, box, cells);
  const double triangle_area = 0.5 * area(box) / (static_cast<double>(cells) * cells);
  for (int iy = 0; iy < cells; ++iy) {
    for (int ix = 0; ix < cells; ++ix) {
      const auto q = corners_of(samples, cells, ix, iy);
      for (const auto& [a, b, c] : {std::array{q[0], q[1], q[2]}, std::array{q[0], q[2], q[3]}}) {
        if (!std::isfinite(a->blocked + b->blocked + c->blocked)) continue;
        const double open = share_below_zero(a->blocked, b->blocked, c->blocked);
        if (open <= 0.0) continue;
        visit({{&a->ray, &b->ray, &c->ray}, {a->point_mm, b->point_mm, c->point_mm}, open, triangle_area});
      }
    }
  }
}

}  // namespace contrejour
