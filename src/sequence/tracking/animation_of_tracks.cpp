// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "contrejour/expert/light_tracks.h"
#include "sequence/tracking/faded_track.h"
#include "sequence/tracking/light_motion.h"
#include "sequence/tracking/thin_keys.h"

namespace contrejour {
namespace {

constexpr double kDimFraction = 0.05;     // of a light's largest flux, below which tolerances do not become smaller
constexpr double kSizeTolerance = 0.1;    // relative
constexpr double kPixelSecondMoment = 1.0 / 6;  // mean squared distance of a pixel's points from its middle

double largest_flux(const LightTrack& track) {
  double largest = 0;
  for (const TrackPoint& point : track.points) largest = std::max(largest, sum_of(point.flux));
  return largest;
}

// The brightest tracks, in the order they came in.
std::vector<const LightTrack*> brightest(std::span<const LightTrack> tracks, std::size_t count) {
  std::vector<std::size_t> order(tracks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return largest_flux(tracks[a]) > largest_flux(tracks[b]); });
  order.resize(std::min(order.size(), count));
  std::sort(order.begin(), order.end());
  std::vector<const LightTrack*> kept;
  for (const std::size_t k : order) kept.push_back(&tracks[k]);
  return kept;
}

KeyedValue position_keys(const FadedTrack& faded, const TrackKeySettings& settings) {
  std::vector<Key> keys;
  for (const TrackPoint& point : faded.points)
    keys.push_back({point.frame, {point.position_px.x / settings.width, point.position_px.y / settings.height}, {}});
  const double u = settings.position_tolerance_px / settings.width,
               v = settings.position_tolerance_px / settings.height;
  return {thinned_keys(keys, [&](const Key&, std::size_t c) { return c == 0 ? u : v; }), Interpolation::Linear};
}

KeyedValue value_keys(const FadedTrack& faded, const TrackKeySettings& settings) {
  std::vector<Key> keys;
  double largest = 0;
  for (const TrackPoint& point : faded.points) {
    keys.push_back({point.frame, {point.flux[0], point.flux[1], point.flux[2]}, {}});
    largest = std::max({largest, point.flux[0], point.flux[1], point.flux[2]});
  }
  return {thinned_keys(keys,
                       [&](const Key& key, std::size_t c) {
                         return settings.value_tolerance * std::max(key.numbers[c], kDimFraction * largest);
                       }),
          Interpolation::Linear};
}

// The diameter of an evenly bright disc of this root mean square radius: 2 sqrt(2) times it.
KeyedValue size_keys(const FadedTrack& faded, double pixel_deg) {
  std::vector<Key> keys;
  for (std::size_t k = 0; k < faded.points.size(); ++k) {
    if (!faded.is_seen[k]) continue;
    const double moment = std::max(0.0, faded.points[k].radius_px * faded.points[k].radius_px - kPixelSecondMoment);
    keys.push_back({faded.points[k].frame, {2.0 * std::sqrt(2.0 * moment) * pixel_deg}, {}});
  }
  return {thinned_keys(
              keys, [&](const Key& key, std::size_t) { return kSizeTolerance * std::max(key.numbers[0], pixel_deg); }),
          Interpolation::Linear};
}

// "on" and "off" where they change; nothing for a light that is always on.
std::optional<KeyedValue> on_keys(const FadedTrack& faded) {
  KeyedValue on;
  for (std::size_t k = 0; k < faded.points.size(); ++k)
    if (k == 0 || faded.is_lit[k] != faded.is_lit[k - 1])
      on.keys.push_back({faded.points[k].frame, {}, faded.is_lit[k] ? "on" : "off"});
  if (on.keys.size() == 1) return std::nullopt;
  return on;
}

AnimatedLight light_of(const LightTrack& track, std::size_t number, std::span<const int> frames,
                       const TrackKeySettings& settings) {
  const FadedTrack faded = faded_track(track, frames, settings.fade_frames);
  AnimatedLight light;
  light.name = fmt::format("light {}", number);
  light.position = position_keys(faded, settings);
  light.value = value_keys(faded, settings);
  if (settings.pixel_deg) light.size_deg = size_keys(faded, *settings.pixel_deg);
  light.on = on_keys(faded);
  return light;
}

}  // namespace

Animation animation_of_tracks(std::span<const LightTrack> tracks, std::span<const int> frames,
                              const TrackKeySettings& settings) {
  Animation animation;
  animation.parameters = {{"detect", {{{0, {}, "off"}}, Interpolation::Linear}}};
  for (const LightTrack* track : brightest(tracks, static_cast<std::size_t>(settings.max_lights)))
    animation.lights.push_back(light_of(*track, animation.lights.size() + 1, frames, settings));
  return animation;
}

}  // namespace contrejour
