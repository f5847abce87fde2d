#include <variant>

#include "contrejour/ghost.h"

namespace contrejour {

// hullin2011 4.1: N = n (n - 1) / 2; 4.2 "aperture culling": N = (f (f - 1) + b (b - 1)) / 2 for f surfaces
// before the stop and b behind it.
std::vector<Ghost> enumerate_ghosts(const LensState& lens, GhostScope scope) {
  const int count = static_cast<int>(lens.surfaces.size());
  const auto reflects = [&](int k) {
    const SurfaceState& s = lens.surfaces[static_cast<std::size_t>(k)];
    const bool only_an_opening = s.before == s.after && std::holds_alternative<Bare>(s.coating.films);
    return s.kind == SurfaceKind::Refracting && !only_an_opening;
  };
  std::vector<Ghost> ghosts;
  for (int i = 0; i < count; ++i) {
    for (int j = i + 1; j < count; ++j) {
      if (!reflects(i) || !reflects(j)) continue;
      const bool spans_stop = i < lens.stop_index && j > lens.stop_index;
      if (spans_stop && scope == GhostScope::OneSideOfStop) continue;
      ghosts.push_back({i + 1, j + 1});
    }
  }
  return ghosts;
}

}  // namespace contrejour
