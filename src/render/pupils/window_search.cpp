// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "render/pupils/open_cells.h"
#include "render/pupils/searches.h"

namespace contrejour::inline internal::pupils {
namespace {

constexpr int kSearchSteps = 10;
constexpr std::array kFirstSides{kSearchSide, 193, 577};  // by PupilEffort
constexpr int kHintSide = 33;
constexpr double kShrinkEnough = 0.85;  // continue while a step shrinks the area below this fraction

struct OpenPart {
  std::optional<Rectangle> pupil_mm;
  Rectangle sensor_mm;
};

// The bounds of the cells that may transmit light, and of their rays on the sensor.
OpenPart open_part(const RayGrid& grid) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  OpenPart part{std::nullopt, {{kFar, kFar}, {-kFar, -kFar}}};
  const auto from_iris = [&](std::size_t c, std::size_t k) { return grid.iris_distance[c][k]; };
  part.pupil_mm = bounds_of_cells(grid, [&](int ix, int iy, bool /*is_within*/) {
    const auto corners = grid.corners(ix, iy);
    if (!may_transmit(grid, corners, from_iris)) return false;
    for (const std::size_t k : corners) {
      if (!(grid.blocked[k] < kFailed)) continue;
      const Vec2 at{grid.sensor_x_mm[k], grid.sensor_y_mm[k]};
      part.sensor_mm = both(part.sensor_mm, {at, at});
    }
    return true;
  });
  return part;
}

// Traces a grid over a box. Nothing is open once the caller cancels.
OpenPart open_part(PupilRays& rays, const Rectangle& box, int side, const Context* context, RayGrid& grid) {
  const Vec2 size = box.high - box.low;
  grid.trace(rays.path, rays.iris, box, side, search_precision(std::min(size.x, size.y) / side), context);
  if (context != nullptr && context->cancelled()) return {};
  return open_part(grid);
}

std::uint64_t squared(int side) { return static_cast<std::uint64_t>(side) * static_cast<std::uint64_t>(side); }

}  // namespace

int first_grid_side(PupilEffort effort) { return kFirstSides[static_cast<std::size_t>(effort)]; }

Pupil search_window(PupilRays& rays, const PupilSearch& wanted, RayGrid& grid) {
  const int side = wanted.side;
  Pupil pupil;
  Rectangle box{rays.window.min_mm, rays.window.max_mm};
  const auto search = [&](int rays_a_side) {
    pupil.rays += squared(rays_a_side);
    return open_part(rays, box, rays_a_side, wanted.context, grid);
  };
  OpenPart part = search(side);
  for (std::size_t k = side < kSearchSide ? 0 : 1; !part.pupil_mm && k <= static_cast<std::size_t>(wanted.effort); ++k)
    part = search(kFirstSides[k]);
  for (int step = 1; part.pupil_mm; ++step) {
    const double before = area_of(box);
    box = *part.pupil_mm;
    pupil.boxes = {box};
    pupil.sensor_mm = part.sensor_mm;
    if (area_of(box) > kShrinkEnough * before || step == kSearchSteps) return pupil;
    part = search(side);
  }
  pupil.boxes.clear();
  return pupil;
}

Pupil search_window_around(PupilRays& rays, const Rectangle& hint, RayGrid& grid) {
  const EntranceWindow& window = rays.window;
  const Rectangle box{{std::max(hint.low.x, window.min_mm.x), std::max(hint.low.y, window.min_mm.y)},
                      {std::min(hint.high.x, window.max_mm.x), std::min(hint.high.y, window.max_mm.y)}};
  if (!(box.low.x < box.high.x && box.low.y < box.high.y)) return {};
  const OpenPart part = open_part(rays, box, kHintSide, nullptr, grid);
  if (!part.pupil_mm) return {};
  const Vec2 step = grid.step_mm() * 0.5;
  const auto cut = [&](double edge, double end, double window_end, double half_step) {
    return std::abs(edge - end) < half_step && end != window_end;
  };
  if (cut(part.pupil_mm->low.x, box.low.x, window.min_mm.x, step.x) ||
      cut(part.pupil_mm->low.y, box.low.y, window.min_mm.y, step.y) ||
      cut(part.pupil_mm->high.x, box.high.x, window.max_mm.x, step.x) ||
      cut(part.pupil_mm->high.y, box.high.y, window.max_mm.y, step.y))
    return {};
  return {{*part.pupil_mm}, part.sensor_mm, squared(kHintSide)};
}

}  // namespace contrejour::inline internal::pupils
