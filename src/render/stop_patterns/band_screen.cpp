// SPDX-License-Identifier: Apache-2.0
#include "render/stop_patterns/band_screen.h"

#include <algorithm>

namespace contrejour::inline internal::screens {

bool BandScreen::is_grey() const { return parts.size() == 1 && parts.front().channel == std::array{1.0F, 1.0F, 1.0F}; }

std::array<double, 3> BandScreen::share(std::span<const StopPlace> places) const {
  std::array<double, 3> sum{};
  for (const Part& part : parts) {
    const double share = part.screen->share(places);
    for (std::size_t c = 0; c < 3; ++c) sum[c] += part.channel[c] * share;
  }
  return sum;
}

// An upper bound of a pattern near `middle`: the largest sample there, but no more than the largest as far from the
// centre.
double BandScreen::brightest(Vec2 middle, double radius) const {
  double beyond = 0.0;
  for (const Part& part : parts)
    beyond = std::max(
        beyond, static_cast<const TextureScreen&>(*part.screen).texture().brightest_beyond(length(middle) - radius));
  return std::min(beyond, static_cast<double>(pattern->brightest(middle, radius)));
}

ScreenView BandScreen::over(Vec2 middle, double radius) const {
  constexpr double kLevel = 1e-3;  // a pattern of the whole iris counts as uniform within this tolerance
  if (edges != nullptr) {
    const double distance = edges->distance(middle);
    const double outside = distance - radius;  // farther out it is darker
    if (outside > dark_beyond) return {ScreenPart::Dark, 0.0};
    return {distance + radius < -level_within ? ScreenPart::Level : ScreenPart::Varied,
            outside > 0.0 ? edges->edge(outside, 0.0) : 1.0};
  }
  if (pattern && hull.misses(middle, radius)) return {ScreenPart::Dark, 0.0};
  const double most = pattern ? std::min(brightest(middle, radius), 1.0) : 1.0;
  const ScreenPart first = parts.front().screen->over(middle, radius, kLevel);
  for (std::size_t k = 1; k < parts.size() && first != ScreenPart::Varied; ++k)
    if (parts[k].screen->over(middle, radius, kLevel) != first) return {ScreenPart::Varied, most};
  return {first, most};
}

}  // namespace contrejour::inline internal::screens
