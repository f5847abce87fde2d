// SPDX-License-Identifier: Apache-2.0
#include "render/pupils/direct_meter.h"

#include <algorithm>
#include <limits>

#include "render/pupils/open_halves.h"
#include "render/pupils/pupil_search.h"

namespace contrejour::inline internal {
namespace {

// Rays along a side of the grid that is summed, and of the grid that is traced; cubics interpolate the others. Few are
// traced where the iris alone bounds the pupil, more where rims do, whose edges meet in corners, and all where rays
// fail.
constexpr int kMeterSide = 97;
constexpr int kSmooth = 6;  // factor of fewer rays
constexpr int kRims = 2;
constexpr int kPicture = 4;  // factor of more rays for a picture's details
constexpr int kFirstSide = 17;  // of the search
// A light beyond the image circle has no pupil, which takes whole grids of rays to find out, so they must not be the
// finest. The direct image's pupil has no islands, and spans several cells of this grid if the lens is no fisheye. A
// fisheye's is hardly larger than a cell over the wide window, so that the search may end with a part of it.
constexpr pupils::PupilEffort kEffort = pupils::PupilEffort::Finer;
constexpr double kMargin = 0.02;  // of a pupil's size, on each side, for another wavelength's
constexpr int kMaxExtensions = 12;  // of a rectangle with a part of the pupil
constexpr float kNearRim = 0.1F;  // of the clear height; of the stop radius

// Most cells are open or closed as a whole.
double open_flux(const RayGrid& grid) {
  const Vec2 step = grid.step_mm();
  double flux = 0.0, whole = 0.0;  // whole: six times the mean transmissions of open cells
  for (int iy = 0; iy < grid.cells(); ++iy) {
    const float* const blocked[2]{&grid.blocked[grid.at(0, iy)], &grid.blocked[grid.at(0, iy + 1)]};
    const float* const light[2]{&grid.transmission[grid.at(0, iy)], &grid.transmission[grid.at(0, iy + 1)]};
    for (int ix = 0; ix < grid.cells(); ++ix) {
      const float a = blocked[0][ix], b = blocked[0][ix + 1], c = blocked[1][ix + 1], d = blocked[1][ix];
      if (std::min(std::min(a, b), std::min(c, d)) > 0.0F) continue;
      if (std::max(std::max(a, b), std::max(c, d)) <= 0.0F)
        whole += 2.0F * (light[0][ix] + light[1][ix + 1]) + light[0][ix + 1] + light[1][ix];
      else
        for_each_open_half(grid, grid.corners(ix, iy), [&](const OpenTriangle& t) { flux += t.flux_mm2; });
    }
  }
  return flux + whole * step.x * step.y / 6.0;
}

bool all_arrived(const RayGrid& grid) {
  return std::all_of(grid.blocked.begin(), grid.blocked.end(), [](float blocked) { return blocked < kFailed; });
}

// True if a rim comes near the light that the iris transmits.
bool is_cut_by_rims(const RayGrid& grid) {
  for (std::size_t k = 0; k < grid.relative_height.size(); ++k) {
    float iris = -kFailed;
    for (std::size_t c = 0; c < static_cast<std::size_t>(grid.stop_crossings()); ++c)
      iris = std::max(iris, grid.iris_distance[c][k]);
    if (iris < kNearRim && grid.relative_height[k] > 1.0F - kNearRim) return true;
  }
  return false;
}

// The rectangle, extended by half its size on each side where light may pass at the border of the grid, but not beyond
// the window.
Rectangle extended_where_open(const RayGrid& grid, const EntranceWindow& window) {
  const int last = grid.cells();
  const auto open_along = [&](int x, int y, int dx, int dy) {
    for (int k = 0; k <= last; ++k)
      if (grid.blocked[grid.at(x + k * dx, y + k * dy)] <= 0.0F) return true;
    return false;
  };
  Rectangle box = grid.box();
  const Vec2 by = (box.high - box.low) * 0.5;
  if (open_along(0, 0, 0, 1)) box.low.x = std::max(box.low.x - by.x, window.min_mm.x);
  if (open_along(last, 0, 0, 1)) box.high.x = std::min(box.high.x + by.x, window.max_mm.x);
  if (open_along(0, 0, 1, 0)) box.low.y = std::max(box.low.y - by.y, window.min_mm.y);
  if (open_along(0, last, 1, 0)) box.high.y = std::min(box.high.y + by.y, window.max_mm.y);
  return box;
}

// The rectangle around the rays that get through, and a cell more on each side, which the pupil's border may cross.
// Some must get through.
Rectangle around_open(const RayGrid& grid) {
  const Vec2 step = grid.step_mm();
  Rectangle open{grid.box().high, grid.box().low};
  for (int iy = 0; iy <= grid.cells(); ++iy)
    for (int ix = 0; ix <= grid.cells(); ++ix) {
      if (grid.blocked[grid.at(ix, iy)] > 0.0F) continue;
      const Vec2 at = grid.box().low + Vec2{ix * step.x, iy * step.y};
      open.low = {std::min(open.low.x, at.x - step.x), std::min(open.low.y, at.y - step.y)};
      open.high = {std::max(open.high.x, at.x + step.x), std::max(open.high.y, at.y + step.y)};
    }
  return open;
}

Rectangle within(const Rectangle& box, const EntranceWindow& window) {
  return {{std::max(box.low.x, window.min_mm.x), std::max(box.low.y, window.min_mm.y)},
          {std::min(box.high.x, window.max_mm.x), std::min(box.high.y, window.max_mm.y)}};
}

Rectangle widened(const Rectangle& box, const EntranceWindow& window) {
  const Vec2 margin = (box.high - box.low) * kMargin;
  return within({box.low - margin, box.high + margin}, window);
}

}  // namespace

DirectMeter::DirectMeter(const LensState& lens, const LightSource& light)
    : lens_(lens), light_(light), iris_(lens.iris), window_(entrance_window(lens, light)) {}

std::optional<Rectangle> DirectMeter::pupil(const ReflectanceTables& tables) const {
  const pupils::PupilRays rays(direct_path(lens_, tables.lambda_nm()), tables, light_, iris_, window_);
  const pupils::Pupil found = find_pupil(rays, {.effort = kEffort, .side = kFirstSide});
  return found.is_empty() ? std::nullopt : std::optional(found.box());
}

// A grid of kMeterSide rays a side over the box, up to rounding in the cubics' refinement.
RayGrid DirectMeter::traced(const ReflectanceTables& tables, const Rectangle& box) const {
  const OpticalPath path = direct_path(lens_, tables.lambda_nm());
  RayGrid grid;
  const auto trace = [&](int side) {
    grid.trace(path, tables, iris_, light_, window_.z_mm, box, side, flux_precision(box));
  };
  const auto all_arrive_with = [&](int refinement) {
    trace((kMeterSide - 1) / refinement + 1);
    return all_arrived(grid);
  };
  const int details = iris_.is_picture() ? kPicture : 1;
  if (!path.obscured && all_arrive_with(kSmooth) && !is_cut_by_rims(grid))
    grid.refine(iris_, kSmooth * details);
  else if (!path.obscured && all_arrive_with(kRims))
    grid.refine(iris_, kRims * details);
  else
    trace((kMeterSide - 1) * details + 1);
  return grid;
}

double DirectMeter::flux_mm2(const ReflectanceTables& tables) const {
  const auto found = pupil(tables);
  return found ? flux_mm2(tables, *found) : 0.0;
}

double DirectMeter::flux_mm2(const ReflectanceTables& tables, const Rectangle& near) const {
  RayGrid grid = traced(tables, widened(near, window_));
  bool is_extended = false;
  for (int k = 0; k < kMaxExtensions; ++k) {
    const Rectangle box = extended_where_open(grid, window_);
    if (box == grid.box()) break;
    grid = traced(tables, box);
    is_extended = true;
  }
  if (is_extended) grid = traced(tables, within(around_open(grid), window_));
  return open_flux(grid) * light_.shared_flux();
}

}  // namespace contrejour::inline internal
