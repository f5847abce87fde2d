// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <span>
#include <variant>

#include "contrejour/expert/check_lens.h"
#include "contrejour/expert/ghost.h"

namespace contrejour {
namespace {

bool reflects(const SurfaceState& s) {
  const bool only_an_opening = s.before == s.after && std::holds_alternative<Bare>(s.coating.films);
  return s.kind != SurfaceKind::Stop && !only_an_opening;
}

// 0-based, ascending.
std::vector<int> reflecting_surfaces(const LensState& lens) {
  std::vector<int> found;
  if (lens.surfaces.size() > kMaxLensSurfaces) return found;
  for (std::size_t k = 0; k < lens.surfaces.size(); ++k)
    if (reflects(lens.surfaces[k])) found.push_back(static_cast<int>(k));
  return found;
}

bool ends_at_grating(const LensState& lens, const Ghost& ghost) {
  return lens.sensor_grating.orders > 0 &&
         lens.surfaces[static_cast<std::size_t>(ghost.j - 1)].kind == SurfaceKind::Sensor;
}

int stop_crossings(const LensState& lens, const Ghost& ghost) {
  const auto stop = static_cast<std::int64_t>(lens.stop_index) + 1;  // an invalid lens may have any index
  int crossings = 0, at = 0;
  const auto go_to = [&](int surface) {
    crossings += (at < stop) != (surface < stop) ? 1 : 0;
    at = surface;
  };
  go_to(ghost.j);
  go_to(ghost.i);
  if (ghost.reflects_four_times()) {
    go_to(ghost.l);
    go_to(ghost.k);
  }
  go_to(std::numeric_limits<int>::max());
  return crossings;
}

bool is_in_scope(const LensState& lens, const Ghost& ghost, GhostScope scope) {
  return stop_crossings(lens, ghost) <= (scope == GhostScope::All ? kMaxStopCrossings : 1);
}

// Adds the ghost, in every order if it reflects at a sensor that is a grating.
void add_orders(const LensState& lens, Ghost ghost, std::vector<Ghost>& to) {
  if (!ends_at_grating(lens, ghost)) {
    to.push_back(ghost);
    return;
  }
  const int max_order = std::min(lens.sensor_grating.orders, SensorStack::kMaxOrders);
  for (int x = -max_order; x <= max_order; ++x) {
    for (int y = -max_order; y <= max_order; ++y) {
      ghost.order = {x, y};
      to.push_back(ghost);
    }
  }
}

// Adds the ghosts of four reflections that begin with those of `two`.
void add_four_fold(const LensState& lens, const Ghost& two, std::span<const int> surfaces, GhostScope scope,
                   std::vector<Ghost>& to) {
  for (const int k : surfaces) {
    for (const int l : surfaces) {
      const Ghost four{two.i, two.j, k + 1, l + 1};
      if (k < l && four.l > four.i && is_in_scope(lens, four, scope)) add_orders(lens, four, to);
    }
  }
}

}  // namespace

// hullin2011 4.1: N = n (n - 1) / 2; 4.2 "aperture culling": N = (f (f - 1) + b (b - 1)) / 2 for f surfaces
// before the stop and b behind it.
std::vector<Ghost> enumerate_ghosts(const LensState& lens, GhostScope scope, Reflections reflections) {
  const std::vector<int> surfaces = reflecting_surfaces(lens);
  std::vector<Ghost> ghosts;
  for (const int i : surfaces) {
    for (const int j : surfaces) {
      const Ghost ghost{i + 1, j + 1};
      if (i >= j || !is_in_scope(lens, ghost, scope)) continue;
      add_orders(lens, ghost, ghosts);
    }
  }
  if (reflections == Reflections::Two) return ghosts;
  for (const int i : surfaces) {
    for (const int j : surfaces)
      if (i < j) add_four_fold(lens, {i + 1, j + 1}, surfaces, scope, ghosts);
  }
  std::sort(ghosts.begin(), ghosts.end());
  return ghosts;
}

bool reflects_at(const LensState& lens, int surface) {
  return surface >= 1 && surface <= static_cast<int>(lens.surfaces.size()) &&
         reflects(lens.surfaces[static_cast<std::size_t>(surface - 1)]);
}

bool has_ghost(const LensState& lens, const Ghost& ghost) {
  if (!has_surfaces_of(lens, ghost)) return false;
  const auto turns_at = [&](int surface) { return reflects_at(lens, surface); };
  if (!turns_at(ghost.i) || !turns_at(ghost.j)) return false;
  if (ghost.reflects_four_times() && !(turns_at(ghost.k) && turns_at(ghost.l))) return false;
  const int max_order = ends_at_grating(lens, ghost) ? lens.sensor_grating.orders : 0;
  return std::abs(ghost.order[0]) <= max_order && std::abs(ghost.order[1]) <= max_order &&
         is_in_scope(lens, ghost, GhostScope::All);
}

}  // namespace contrejour
