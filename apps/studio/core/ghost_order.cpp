// SPDX-License-Identifier: Apache-2.0
#include "studio/core/ghost_order.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace contrejour::studio {
namespace {

constexpr double kSmallest_px = 2.0;  // about what a focused spot covers

// The part of a ghost's extent along one axis that lies in the frame.
double part_inside(double middle, double size, double frame) {
  const double half = 0.5 * std::fmax(size, kSmallest_px);
  const double inside = std::fmin(middle + half, frame) - std::fmax(middle - half, 0.0);
  return std::clamp(inside / (2.0 * half), 0.0, 1.0);
}

}  // namespace

const char* name_of(GhostOrder order) {
  switch (order) {
    case GhostOrder::Visibility: return "by visibility";
    case GhostOrder::Flux: return "by flux";
    case GhostOrder::Peak: return "by peak";
  }
  return "";
}

double part_in_frame(const GhostFigures& ghost, Vec2 frame_px) {
  return part_inside(ghost.centroid_px.x, ghost.size_px.x, frame_px.x) *
         part_inside(ghost.centroid_px.y, ghost.size_px.y, frame_px.y);
}

double visibility(const GhostFigures& ghost, Vec2 frame_px) {
  const Vec2 size{std::fmax(ghost.size_px.x, kSmallest_px), std::fmax(ghost.size_px.y, kSmallest_px)};
  return ghost.relative_flux * part_in_frame(ghost, frame_px) / std::sqrt(size.x * size.y);
}

std::vector<std::size_t> ghosts_in_order(const std::vector<GhostFigures>& figures, GhostOrder order, Vec2 frame_px) {
  std::vector<double> key;
  for (const GhostFigures& f : figures)
    key.push_back(order == GhostOrder::Visibility ? visibility(f, frame_px)
                  : order == GhostOrder::Peak     ? f.peak_irradiance
                                                  : f.relative_flux);
  std::vector<std::size_t> rows(figures.size());
  std::iota(rows.begin(), rows.end(), std::size_t{0});
  std::ranges::stable_sort(rows, [&](std::size_t a, std::size_t b) { return key[a] > key[b]; });
  return rows;
}

}  // namespace contrejour::studio
