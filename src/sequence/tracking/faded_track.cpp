// SPDX-License-Identifier: Apache-2.0
#include "sequence/tracking/faded_track.h"

#include <algorithm>
#include <cstdlib>

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kPointsOfVelocity = 4;  // at an end of a track: more of them average noise, fewer follow turns

// The change a frame between two points of a track.
Vec2 velocity_between(const TrackPoint& a, const TrackPoint& b) {
  if (a.frame == b.frame) return {};
  return (b.position_px - a.position_px) * (1.0 / (b.frame - a.frame));
}

// The track's position in a frame, which may be outside its own.
TrackPoint point_at(const std::vector<TrackPoint>& points, int frame) {
  const auto after = std::lower_bound(points.begin(), points.end(), frame,
                                      [](const TrackPoint& point, int at) { return point.frame < at; });
  if (after != points.end() && after->frame == frame) return *after;
  const std::size_t reach = std::min(points.size(), kPointsOfVelocity) - 1;
  TrackPoint from = points.front();
  Vec2 velocity;
  if (after == points.begin()) {
    velocity = velocity_between(points.front(), points[reach]);
  } else if (after == points.end()) {
    from = points.back();
    velocity = velocity_between(points[points.size() - 1 - reach], points.back());
  } else {
    from = *(after - 1);
    velocity = velocity_between(from, *after);
    const double t = static_cast<double>(frame - from.frame) / (after->frame - from.frame);
    from.radius_px += t * (after->radius_px - from.radius_px);
  }
  return {frame, from.position_px + (frame - from.frame) * velocity, {}, from.radius_px};
}

void raise(Rgb& flux, const Rgb& other, double weight) {
  for (std::size_t c = 0; c < 3; ++c) flux[c] = std::max(flux[c], weight * other[c]);
}

// The frames of the shot that the track has a point for.
struct FrameSpan {
  std::ptrdiff_t from = 0, to = 0;  // [from, to)
};

FrameSpan frames_near(const LightTrack& track, std::span<const int> frames, int fade) {
  const auto index = [&](int frame) { return std::lower_bound(frames.begin(), frames.end(), frame) - frames.begin(); };
  const std::ptrdiff_t first = index(track.points.front().frame), last = index(track.points.back().frame);
  const auto count = static_cast<std::ptrdiff_t>(frames.size());
  return {std::max<std::ptrdiff_t>(0, first - fade - 1), std::min<std::ptrdiff_t>(count, last + fade + 2)};
}

// After the light was last seen, in the direction of the step, its flux falls by at most 1 / (fade_frames + 1) of
// itself from frame to frame. This holds for the frames that follow and for the last ones that it is seen in, because
// it may be nearly covered there.
void add_fades(FadedTrack& faded, const std::vector<Rgb>& seen_flux, int fade_frames, std::ptrdiff_t step) {
  const auto count = static_cast<std::ptrdiff_t>(faded.points.size());
  const auto is_seen = [&](std::ptrdiff_t k) {
    return k >= 0 && k < count && faded.is_seen[static_cast<std::size_t>(k)];
  };
  for (std::ptrdiff_t end = 0; end < count; ++end) {
    if (!is_seen(end) || is_seen(end + step) || end + step < 0 || end + step >= count) continue;
    for (std::ptrdiff_t from = end; is_seen(from) && std::abs(end - from) <= fade_frames; from -= step) {
      for (std::ptrdiff_t k = 1; k <= fade_frames; ++k) {
        const std::ptrdiff_t to = from + k * step;
        if (to < 0 || to >= count) break;
        const auto at = static_cast<std::size_t>(to);
        raise(faded.points[at].flux, seen_flux[static_cast<std::size_t>(from)],
              1.0 - static_cast<double>(k) / (fade_frames + 1));
        faded.is_lit[at] = true;
      }
    }
  }
}

std::vector<Rgb> fluxes_of(const FadedTrack& faded) {
  std::vector<Rgb> fluxes;
  for (const TrackPoint& point : faded.points) fluxes.push_back(point.flux);
  return fluxes;
}

}  // namespace

FadedTrack faded_track(const LightTrack& track, std::span<const int> frames, int fade_frames) {
  const FrameSpan span = frames_near(track, frames, fade_frames);
  FadedTrack faded;
  for (std::ptrdiff_t k = span.from; k < span.to; ++k) {
    const int frame = frames[static_cast<std::size_t>(k)];
    const bool is_seen = std::binary_search(track.points.begin(), track.points.end(), TrackPoint{frame, {}, {}, 0},
                                            [](const TrackPoint& a, const TrackPoint& b) { return a.frame < b.frame; });
    faded.points.push_back(point_at(track.points, frame));
    faded.is_seen.push_back(is_seen);
    faded.is_lit.push_back(is_seen);
  }
  const std::vector<Rgb> seen_flux = fluxes_of(faded);
  add_fades(faded, seen_flux, fade_frames, 1);
  add_fades(faded, seen_flux, fade_frames, -1);
  for (std::size_t k = 0; k < faded.points.size() && !track.begins_apart && !faded.is_seen[k]; ++k) {
    faded.points[k].flux = {};
    faded.is_lit[k] = false;
  }
  return faded;
}

}  // namespace contrejour::inline internal
