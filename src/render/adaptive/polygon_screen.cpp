#include "render/adaptive/polygon_screen.h"

#include <algorithm>
#include <cmath>

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
  const ScreenPart first = parts.front().screen->over(middle, radius, kLevel);
  for (std::size_t k = 1; k < parts.size() && first != ScreenPart::Varied; ++k)
    if (parts[k].screen->over(middle, radius, kLevel) != first) return ScreenPart::Varied;
  return first;
}

StopMap::StopMap(const std::array<Corner, 3>& corners, int crossings)
    : origin_px_(corners[0].pixel), crossings_(static_cast<std::size_t>(crossings)) {
  const Vec2 u = corners[1].pixel - origin_px_, v = corners[2].pixel - origin_px_;
  const double turn = cross(u, v);
  // (u, v) of a pixel q from the origin: cross(q, v) / turn and cross(u, q) / turn.
  const double scale = turn != 0.0 ? 1.0 / turn : 0.0;
  const double longest = std::max({length(u), length(v), length(v - u)});
  thickness_px_ = longest > 0.0 ? std::abs(turn) / longest : 0.0;
  u_ = v * scale;
  v_ = u * scale;
  for (std::size_t c = 0; c < crossings_; ++c) {
    const Vec2 origin = corners[0].stop[c];
    const Vec2 along_u = corners[1].stop[c] - origin, along_v = corners[2].stop[c] - origin;
    const double pixels = std::max(0.5 * std::abs(turn), 1.0);
    crossing_[c] = {origin, along_u, along_v, std::sqrt(0.5 * std::abs(cross(along_u, along_v)) / pixels)};
  }
}

std::span<const StopPlace> StopMap::places(Vec2 pixel, std::array<StopPlace, kMaxStopCrossings>& room) const {
  const Vec2 q = pixel - origin_px_;
  double u = std::max(cross(q, u_), 0.0), v = std::max(cross(v_, q), 0.0);
  if (u + v > 1.0) {
    const double scale = 1.0 / (u + v);
    u *= scale;
    v *= scale;
  }
  for (std::size_t c = 0; c < crossings_; ++c)
    room[c] = {crossing_[c].origin + crossing_[c].along_u * u + crossing_[c].along_v * v, crossing_[c].width};
  return {room.data(), crossings_};
}

}  // namespace contrejour::adaptive
