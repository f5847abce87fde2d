// SPDX-License-Identifier: Apache-2.0
#include "render/stop_patterns/iris_screens.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace contrejour::inline internal::screens {
namespace {

// In stop radii: pixels that cross the rim have their middle beyond it.
constexpr double kSharpReach = 1.05;

// The fraction of a square, `width` wide, that is inside a straight edge `distance` from its middle.
double sharp_share(double distance, double width) {
  if (!(width > 0.0)) return distance <= 0.0 ? 1.0 : 0.0;
  return std::clamp(0.5 - distance / width, 0.0, 1.0);
}

}  // namespace

double IrisScreen::distance(Vec2 p) const {
  if (iris_->is_picture()) return iris_->picture_distance(p);
  double largest = -std::numeric_limits<double>::infinity();
  for (const IrisBound& bound : iris_->bounds()) largest = std::max(largest, bound.distance(p));
  return largest;
}

double IrisScreen::tone(const StopPlace& place) const {
  return iris_->has_tones() ? iris_->picture_transmittance(place.at, place.width) : 1.0;
}

double IrisScreen::share(std::span<const StopPlace> places) const {
  if (places.empty()) return 1.0;
  double all = pattern(places.back());
  for (const StopPlace& earlier : places.first(places.size() - 1))
    if (all > 0.0) all *= sharp_share(distance(earlier.at), earlier.width) * tone(earlier);
  return all;
}

EdgeScreen::EdgeScreen(std::shared_ptr<const IrisShape> iris, std::shared_ptr<const EdgeProfile> profile,
                       double fresnel_number)
    : IrisScreen(std::move(iris)), profile_(std::move(profile)), scale_(std::sqrt(2.0 * fresnel_number)) {}

double EdgeScreen::reach() const { return 1.0 - EdgeProfile::kDarkBelow / scale_; }

double EdgeScreen::pattern(const StopPlace& place) const {
  if (iris().is_picture()) return edge(iris().picture_distance(place.at), place.width);
  double all = 1.0;
  for (const IrisBound& bound : iris().bounds()) {
    if (!(all > 0.0)) break;
    all *= edge(bound.distance(place.at), place.width);
  }
  return std::max(all, 0.0);
}

ScreenPart EdgeScreen::over(Vec2 middle, double radius, double tolerance) const {
  const double from_edge = distance(middle);
  if (scale_ * (from_edge - radius) > -EdgeProfile::kDarkBelow) return ScreenPart::Dark;
  return scale_ * (-from_edge - radius) > profile_->level_above(tolerance) ? ScreenPart::Level : ScreenPart::Varied;
}

double TonedScreen::reach() const { return edges_ ? edges_->reach() : kSharpReach; }

double TonedScreen::pattern(const StopPlace& place) const {
  const double from_edge = distance(place.at);
  const double open = edges_ ? edges_->edge(from_edge, place.width) : sharp_share(from_edge, place.width);
  return open > 0.0 ? open * tone(place) : 0.0;
}

ScreenPart TonedScreen::over(Vec2 middle, double radius, double tolerance) const {
  const bool dark = edges_ ? edges_->over(middle, radius, tolerance) == ScreenPart::Dark : distance(middle) > radius;
  return dark ? ScreenPart::Dark : ScreenPart::Varied;
}

double TextureScreen::reach() const { return texture_->extent(); }

double TextureScreen::pattern(const StopPlace& place) const { return texture_->at(place.at, place.width); }

ScreenPart TextureScreen::over(Vec2 middle, double radius, double /*tolerance*/) const {
  return length(middle) - radius > reach() ? ScreenPart::Dark : ScreenPart::Varied;
}

}  // namespace contrejour::inline internal::screens
