// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "render/pupils/clearance_grid.h"
#include "render/pupils/meridian_scan.h"
#include "render/pupils/searches.h"
#include "render/pupils/stop_newton_step.h"

namespace contrejour::inline internal::pupils {
namespace {

constexpr int kFirstColumns = 12;  // of the first grid, over the window; half as many rows from y = 0 up
constexpr int kZoomColumns = 8;        // of the other grids; half as many rows for boxes that touch y = 0
constexpr int kMaxColumns = 32;
constexpr float kFirstMargin = 1.0F;  // ClearanceGrid::may_transmit
constexpr float kBoxMargin = 0.5F;
constexpr double kGrowth = 1.0;  // of a box's size, on a side at which rays get through
constexpr int kMaxGrowths = 2;
constexpr int kMaxZoomDepth = 12;     // levels of grids, each in a part of the preceding one
constexpr int kMaxDark = 2;     // consecutive levels without a ray that gets through
constexpr std::uint64_t kMaxRays = 3000;
constexpr double kTight = 0.4;         // fraction of open corners at which cells fit well enough
constexpr double kWorthZooming = 0.6;  // of the area
constexpr double kConvergedStep = 0.15;      // stop radii, error of an aim that is accepted
// Around a hint:
constexpr int kFitColumns = 8;
constexpr double kWidening = 0.2;  // of a box's size, on a side whose border transmits light
constexpr int kMaxWidenings = 4;
constexpr float kFitMargin = 0.5F;  // ClearanceGrid::may_transmit

double area_if_any(const Rectangle& r) { return std::max(r.high.x - r.low.x, 0.0) * std::max(r.high.y - r.low.y, 0.0); }

Rectangle common(const Rectangle& a, const Rectangle& b) {
  return {{std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y)},
          {std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y)}};
}

// A part of the upper half of the entrance plane that is still to be searched.
struct Part {
  Rectangle box;
  int columns = kZoomColumns;
  int depth = 0;
  int dark = 0;  // grids since one had a ray that gets through
};

// The upper half of a window.
Rectangle upper_half(const EntranceWindow& window) {
  return {{window.min_mm.x, 0.0}, {window.max_mm.x, std::max(std::abs(window.min_mm.y), window.max_mm.y)}};
}

class MeridianSearch {
 public:
  explicit MeridianSearch(const PupilRays& rays)
      : grid_(rays.path), meridian_(rays.path), half_(upper_half(rays.window)) {}

  Pupil run() {
    grid_.trace(half_, kFirstColumns, kFirstColumns / 2);
    consider({half_}, kFirstMargin);
    search_parts();
    for (const Interval& i : meridian_.find({half_.low.x, half_.high.x}, boxes_)) {
      const double width = i.high - i.low;
      parts_.push_back({common({{i.low - 0.5 * width, 0.0}, {i.high + 0.5 * width, width}}, half_)});
    }
    search_parts();
    return {std::move(boxes_), {}, grid_.rays() + meridian_.rays()};
  }

 private:
  void search_parts() {
    while (!parts_.empty()) {
      Part part = parts_.back();
      parts_.pop_back();
      for (int step = 0; step <= kMaxGrowths; ++step) {
        grid_.trace(part.box, part.columns, part.box.low.y == 0.0 ? part.columns / 2 : part.columns);
        const Rectangle next = grid_.grown(kGrowth, half_);
        if (next.low == part.box.low && next.high == part.box.high) break;
        part.box = next;
      }
      consider(part, kBoxMargin);
    }
  }

  // Each connected piece of the grid over `part` becomes a box or a part to be searched, or is dropped.
  void consider(const Part& part, float margin) {
    for (const auto& piece : grid_.components(margin)) {
      const Rectangle hull = grid_.hull(piece);
      int open = 0;
      for (const GridCell& cell : piece) open += grid_.open_corners(cell);
      Rectangle next = hull;
      const auto aim = newton_step_to_stop(grid_, piece);
      if (aim && area_if_any(common(hull, aim->box)) > 0.0) {
        next = common(hull, aim->box);
        if (aim->error < kConvergedStep && open > 0) {
          add_box(next);
          continue;
        }
      }
      const bool shrunk = area_if_any(next) < kWorthZooming * area_if_any(grid_.box());
      const bool tight = open >= kTight * 4.0 * static_cast<double>(piece.size());
      const int dark = open > 0 ? 0 : part.dark + 1;
      const bool last =
          part.depth == kMaxZoomDepth || grid_.rays() > kMaxRays || (!shrunk && part.columns >= kMaxColumns);
      if (open > 0 && ((tight && !shrunk) || last)) {
        add_box(next);
      } else if (!last && dark < kMaxDark) {
        parts_.push_back({next, shrunk ? part.columns : 2 * part.columns, part.depth + 1, dark});
      }
    }
  }

  // Adds a box with its mirror image, or a single one if it touches the axis.
  void add_box(const Rectangle& b) {
    if (b.low.y <= 0.0) {
      boxes_.push_back({{b.low.x, -b.high.y}, b.high});
    } else {
      boxes_.push_back(b);
      boxes_.push_back({{b.low.x, -b.high.y}, {b.high.x, -b.low.y}});
    }
  }

  ClearanceGrid grid_;
  MeridianScan meridian_;
  Rectangle half_;
  std::vector<Part> parts_;
  std::vector<Rectangle> boxes_;
};

}  // namespace

Pupil search_meridian(const PupilRays& rays, const PupilSearch& search) {
  if (!search.only_through_line) return MeridianSearch(rays).run();
  MeridianScan line(rays.path);
  const bool is_open = !line.find({rays.window.min_mm.x, rays.window.max_mm.x}, {}).empty();
  Pupil pupil = is_open ? MeridianSearch(rays).run() : Pupil{};
  pupil.rays += line.rays();
  return pupil;
}

Pupil search_meridian_around(const PupilRays& rays, const Rectangle& hint) {
  const Rectangle window = upper_half(rays.window);
  ClearanceGrid grid(rays.path);
  Rectangle half{{hint.low.x, std::max(hint.low.y, 0.0)}, hint.high};
  for (int step = 0;; ++step) {
    grid.trace(half, kFitColumns, half.low.y == 0.0 ? kFitColumns / 2 : kFitColumns);
    if (step == kMaxWidenings) break;
    const Rectangle next = grid.grown(kWidening, window);
    if (next.low == half.low && next.high == half.high) break;
    half = next;
  }
  std::optional<Rectangle> hull;
  for (const auto& piece : grid.components(kFitMargin)) {
    const Rectangle one = grid.hull(piece);
    if (!hull) hull = one;
    hull->low = {std::min(hull->low.x, one.low.x), std::min(hull->low.y, one.low.y)};
    hull->high = {std::max(hull->high.x, one.high.x), std::max(hull->high.y, one.high.y)};
  }
  if (hull && hull->low.y == 0.0) hull->low.y = -hull->high.y;
  Pupil pupil{{}, {}, grid.rays()};
  if (hull) pupil.boxes.push_back(*hull);
  return pupil;
}

}  // namespace contrejour::inline internal::pupils
