#include "render/adaptive/polygon_screen.h"

#include <algorithm>

namespace contrejour::adaptive {

std::array<double, 3> BandScreen::share(std::span<const StopPlace> places) const {
  std::array<double, 3> sum{};
  for (const Part& part : parts) {
    const double share = part.screen->share(places);
    for (std::size_t c = 0; c < 3; ++c) sum[c] += part.channel[c] * share;
  }
  return sum;
}

ScreenPart BandScreen::over(Vec2 middle, double radius) const {
  constexpr double kLevel = 1e-3;  // of a pattern of all the iris: so close to 1
  if (edges != nullptr) {
    const double distance = edges->distance(middle);
    if (distance - radius > dark_beyond) return ScreenPart::Dark;
    return distance + radius < -level_within ? ScreenPart::Level : ScreenPart::Varied;
  }
  if (pattern && length(middle) - radius > reach) return ScreenPart::Dark;
  const ScreenPart first = parts.front().screen->over(middle, radius, kLevel);
  for (std::size_t k = 1; k < parts.size() && first != ScreenPart::Varied; ++k)
    if (parts[k].screen->over(middle, radius, kLevel) != first) return ScreenPart::Varied;
  return first;
}

double BandScreen::most_over(Vec2 middle, double radius) const {
  if (pattern) return std::min(static_cast<double>(pattern->brightest(middle, radius)), 1.0);
  if (edges == nullptr) return 1.0;
  const double outside = edges->distance(middle) - radius;  // farther out it is darker
  return outside > 0.0 ? edges->edge(outside, 0.0) : 1.0;
}

}  // namespace contrejour::adaptive
