// SPDX-License-Identifier: Apache-2.0
#include "ghosts/pupil_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace contrejour::inline internal {
namespace {

constexpr int kSearchSteps = 10;
constexpr std::array kFirstSides{kSearchSide, 193, 577};  // by PupilEffort
constexpr int kGuessSide = 33;
constexpr double kShrinkEnough = 0.85;  // continue while a step shrinks the area below this fraction
constexpr float kInfinity = std::numeric_limits<float>::infinity();

// The amount by which a ray is blocked is nearly linear over a cell, so it cannot fall below its lowest corner by more
// than the corners differ. A corner whose ray fails is ignored.
class Extremes {
 public:
  void add(float value) {
    lowest_ = std::min(lowest_, value);
    highest_ = std::max(highest_, value);
  }
  [[nodiscard]] bool may_transmit() const { return lowest_ <= 0.0F || lowest_ <= highest_ - lowest_; }

 private:
  float lowest_ = kInfinity;
  float highest_ = -kInfinity;
};

bool may_be_open(const RayGrid& grid, const std::array<std::size_t, 4>& corners) {
  Extremes rims;
  std::array<Extremes, kMaxStopCrossings> iris;
  bool any = false;
  for (const std::size_t k : corners) {
    if (grid.blocked[k] == kInfinity) continue;
    any = true;
    rims.add(grid.r_rel[k] - 1.0F);
    for (std::size_t c = 0; c < static_cast<std::size_t>(grid.stop_crossings()); ++c) {
      iris[c].add(grid.iris_distance[c][k]);
    }
  }
  if (!any || !rims.may_transmit()) return false;
  for (std::size_t c = 0; c < static_cast<std::size_t>(grid.stop_crossings()); ++c) {
    if (!iris[c].may_transmit()) return false;
  }
  return true;
}

struct OpenPart {
  Rectangle pupil_mm{{kInfinity, kInfinity}, {-kInfinity, -kInfinity}};
  Rectangle sensor_mm{{kInfinity, kInfinity}, {-kInfinity, -kInfinity}};
  bool any = false;
};

void grow(Rectangle& r, Vec2 p) {
  r.low = {std::min(r.low.x, p.x), std::min(r.low.y, p.y)};
  r.high = {std::max(r.high.x, p.x), std::max(r.high.y, p.y)};
}

OpenPart open_part(const RayGrid& grid) {
  OpenPart part;
  const Vec2 step = grid.step_mm();
  for (int iy = 0; iy < grid.cells(); ++iy) {
    for (int ix = 0; ix < grid.cells(); ++ix) {
      const auto corners = grid.corners(ix, iy);
      if (!may_be_open(grid, corners)) continue;
      part.any = true;
      grow(part.pupil_mm, grid.box().low + Vec2{ix * step.x, iy * step.y});
      grow(part.pupil_mm, grid.box().low + Vec2{(ix + 1) * step.x, (iy + 1) * step.y});
      for (const std::size_t k : corners) {
        if (grid.blocked[k] < kInfinity) grow(part.sensor_mm, {grid.sensor_x_mm[k], grid.sensor_y_mm[k]});
      }
    }
  }
  return part;
}

PacketPrecision precision_for(const Rectangle& box, int side) {
  const Vec2 size = box.high - box.low;
  return search_precision(std::min(size.x, size.y) / side);
}

}  // namespace

int first_grid_side(PupilEffort effort) { return kFirstSides[static_cast<std::size_t>(effort)]; }

PupilEffort effort_for_grid(int side) {
  constexpr int kFiner = 12;  // factor of rays along each side, for the finest grid of a search
  for (const PupilEffort effort : {PupilEffort::Finest, PupilEffort::Finer})
    if (first_grid_side(effort) <= kFiner * side) return effort;
  return PupilEffort::Once;
}

std::optional<PupilRegion> find_pupil_region(const OpticalPath& path, const ReflectanceTables& tables,
                                             const IrisShape& iris, const LightSource& light,
                                             const EntranceWindow& window, RayGrid& scratch, PupilEffort effort,
                                             int side) {
  if (path.obscured)
    return find_pupil_region(without_obscurations(path), tables, iris, light, window, scratch, effort, side);
  PupilRegion region{{window.min_mm, window.max_mm}, {}, 0};
  const IrisShape hull = iris.hull();
  const auto search = [&](int rays) {
    scratch.trace(path, tables, hull, light, window.z_mm, region.pupil_mm, rays, precision_for(region.pupil_mm, rays));
    region.rays += static_cast<std::uint64_t>(rays) * static_cast<std::uint64_t>(rays);
    return open_part(scratch);
  };
  OpenPart part = search(side);
  for (std::size_t k = side < kSearchSide ? 0 : 1; !part.any && k <= static_cast<std::size_t>(effort); ++k) {
    part = search(kFirstSides[k]);
  }
  for (int step = 1; part.any; ++step) {
    const double before = area_of(region.pupil_mm);
    region.pupil_mm = part.pupil_mm;
    region.sensor_mm = part.sensor_mm;
    if (area_of(part.pupil_mm) > kShrinkEnough * before || step == kSearchSteps) return region;
    part = search(side);
  }
  return std::nullopt;
}

std::optional<PupilRegion> find_pupil_region_in(const Rectangle& guess, const OpticalPath& path,
                                                const ReflectanceTables& tables, const IrisShape& iris,
                                                const LightSource& light, const EntranceWindow& window,
                                                RayGrid& scratch) {
  if (path.obscured)
    return find_pupil_region_in(guess, without_obscurations(path), tables, iris, light, window, scratch);
  const Rectangle box{{std::max(guess.low.x, window.min_mm.x), std::max(guess.low.y, window.min_mm.y)},
                      {std::min(guess.high.x, window.max_mm.x), std::min(guess.high.y, window.max_mm.y)}};
  if (!(box.low.x < box.high.x && box.low.y < box.high.y)) return std::nullopt;
  scratch.trace(path, tables, iris.hull(), light, window.z_mm, box, kGuessSide, precision_for(box, kGuessSide));
  const OpenPart part = open_part(scratch);
  if (!part.any) return std::nullopt;
  const Vec2 step = scratch.step_mm() * 0.5;
  const auto cut = [&](double edge, double end, double window_end, double half_step) {
    return std::abs(edge - end) < half_step && end != window_end;
  };
  if (cut(part.pupil_mm.low.x, box.low.x, window.min_mm.x, step.x) ||
      cut(part.pupil_mm.low.y, box.low.y, window.min_mm.y, step.y) ||
      cut(part.pupil_mm.high.x, box.high.x, window.max_mm.x, step.x) ||
      cut(part.pupil_mm.high.y, box.high.y, window.max_mm.y, step.y)) {
    return std::nullopt;
  }
  return PupilRegion{part.pupil_mm, part.sensor_mm, static_cast<std::uint64_t>(kGuessSide) * kGuessSide};
}

}  // namespace contrejour::inline internal
