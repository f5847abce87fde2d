// SPDX-License-Identifier: Apache-2.0
#include "sequence/tracking/light_tracker.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sequence/tracking/assignment.h"
#include "sequence/tracking/shared_areas.h"

namespace contrejour::inline internal {
namespace {

// A light without a detection, or a detection without a light, costs this much; less at the edge of the picture, where
// lights leave and enter.
constexpr double kCostOfNoPair = 8.0, kCostOfNoPairAtEdge = 3.0;
constexpr double kGainUnit = 1e4;  // gains are whole numbers of 1 / kGainUnit
constexpr std::size_t kMinForCommonMotion = 2;

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Vec2 median(const std::vector<Vec2>& vectors) {
  std::vector<double> x, y;
  for (const Vec2 v : vectors) {
    x.push_back(v.x);
    y.push_back(v.y);
  }
  return {median(std::move(x)), median(std::move(y))};
}

// A displacement that the camera's shake adds to all lights alike, if they agree on one.
std::optional<Vec2> common_displacement(const std::vector<Vec2>& displacements) {
  if (displacements.size() < kMinForCommonMotion) return std::nullopt;
  const Vec2 common = median(displacements);
  std::vector<double> deviations;
  for (const Vec2 v : displacements) deviations.push_back(length(v - common));
  if (median(std::move(deviations)) > 2.0 + 0.25 * length(common)) return std::nullopt;
  return common;
}

std::vector<Vec2> displacements_of(std::span<const LightMotion> motions, const FrameLights& frame,
                                   std::span<const int> detection_of_light) {
  std::vector<Vec2> all, of_known;  // known: with a velocity
  for (std::size_t k = 0; k < motions.size(); ++k) {
    if (detection_of_light[k] < 0) continue;
    const auto d = static_cast<std::size_t>(detection_of_light[k]);
    all.push_back(frame.lights[d].centroid_px - motions[k].predicted_px);
    if (motions[k].has_velocity()) of_known.push_back(all.back());
  }
  return of_known.size() >= kMinForCommonMotion ? of_known : all;
}

// The motion that most lights share, for lights that have just appeared.
Vec2 common_velocity(std::span<const LightMotion> motions) {
  std::vector<Vec2> velocities;
  for (const LightMotion& motion : motions)
    if (motion.has_velocity()) velocities.push_back(motion.velocity_px);
  return common_displacement(velocities).value_or(Vec2{});
}

bool is_outside(const PixelRegion& picture, Vec2 point) {
  return point.x < picture.x0 || point.x >= picture.x1 || point.y < picture.y0 || point.y >= picture.y1;
}

double cost_of_no_pair(const PixelRegion& picture, Vec2 point, double margin) {
  const PixelRegion& p = picture;
  const double inside = std::min({point.x - p.x0, p.x1 - point.x, point.y - p.y0, p.y1 - point.y});
  return inside < margin ? kCostOfNoPairAtEdge : kCostOfNoPair;
}

// The lights in one detection keep their distances, and have its flux in proportion to their own.
void share(std::span<LightMotion> motions, const std::vector<std::size_t>& members, int frame,
           const DetectedLight& light) {
  Rgb sum{};
  Vec2 centroid;
  double total = 0;
  for (const std::size_t k : members) {
    for (std::size_t c = 0; c < 3; ++c) sum[c] += motions[k].flux[c];
    centroid = centroid + sum_of(motions[k].flux) * motions[k].predicted_px;
    total += sum_of(motions[k].flux);
  }
  const Vec2 shift = light.centroid_px - centroid * (1.0 / total);
  for (const std::size_t k : members) {
    Rgb flux;
    for (std::size_t c = 0; c < 3; ++c)
      flux[c] = light.flux[c] * (sum[c] > 0.0 ? motions[k].flux[c] / sum[c] : sum_of(motions[k].flux) / total);
    take_part(motions[k], frame, motions[k].predicted_px + shift, flux);
  }
}

}  // namespace

std::vector<int> LightTracker::pair_up(const FrameLights& frame, bool wide) const {
  const double search = settings_.search_px;
  std::vector<PairGain> pairs;
  for (std::size_t k = 0; k < motions_.size(); ++k) {
    const LightMotion& motion = motions_[k];
    const double radius = wide ? search : search_radius_px(motion, search);
    const double tolerance = motion.has_velocity() && !wide ? 0.0 : 0.15 * search;
    const double margin = 2.0 * motion.radius_px + length(motion.velocity_px) + tolerance;
    const double hidden = cost_of_no_pair(frame.picture, motion.predicted_px, margin);
    for (std::size_t d = 0; d < frame.lights.size(); ++d) {
      const Vec2 at = frame.lights[d].centroid_px;
      if (length(at - motion.predicted_px) > radius) continue;
      const double alone = hidden + cost_of_no_pair(frame.picture, at, margin);
      const auto gain = static_cast<std::int64_t>(kGainUnit * (alone - cost_of(motion, frame.lights[d], tolerance)));
      if (gain > 0) pairs.push_back({static_cast<int>(k), static_cast<int>(d), gain});
    }
  }
  return best_assignment(static_cast<int>(motions_.size()), static_cast<int>(frame.lights.size()), pairs);
}

// Predicts by each light's velocity, then by what the camera's motion changes for all of them.
void LightTracker::predict(const FrameLights& frame) {
  for (LightMotion& motion : motions_)
    motion.predicted_px = motion.position_px + (frame.frame - motion.position_frame) * motion.velocity_px;
  const Vec2 shift = common_displacement(displacements_of(motions_, frame, pair_up(frame, true))).value_or(Vec2{});
  for (LightMotion& motion : motions_) {
    motion.camera_px = shift;
    if (!motion.next_is_known()) motion.predicted_px = motion.predicted_px + shift;
  }
}

void LightTracker::take_pairs(const FrameLights& frame, std::span<const int> detection_of_light) {
  const std::vector<int> light_of = lights_of_parts(motions_, frame.lights, detection_of_light);
  const std::vector<int> shared = detections_shared(motions_, frame.lights, detection_of_light);
  for (std::size_t k = 0; k < motions_.size(); ++k) {
    if (detection_of_light[k] < 0) continue;
    const auto main = static_cast<std::size_t>(detection_of_light[k]);
    DetectedLight light = frame.lights[main];
    bool is_whole = true;
    for (std::size_t d = 0; d < light_of.size(); ++d) {
      if (light_of[d] != static_cast<int>(k) || d == main) continue;
      light = as_one(light, frame.lights[d]);
      is_whole = false;
    }
    std::vector<std::size_t> members{k};
    for (std::size_t j = 0; j < shared.size(); ++j)
      if (shared[j] == detection_of_light[k]) members.push_back(j);
    if (members.size() == 1) {
      take(motions_[k], frame.frame, light, is_whole);
    } else {
      share(motions_, members, frame.frame, light);
    }
  }
  std::vector<bool> is_taken(frame.lights.size());
  for (std::size_t d = 0; d < is_taken.size(); ++d) is_taken[d] = light_of[d] >= 0;
  add_new_lights(frame, is_taken);
}

void LightTracker::add_new_lights(const FrameLights& frame, const std::vector<bool>& is_taken) {
  const Vec2 velocity = common_velocity(motions_);
  for (std::size_t d = 0; d < frame.lights.size(); ++d) {
    if (is_taken[d]) continue;
    const std::optional<Vec2> known = starts_.of(frame.frame, frame.lights[d].centroid_px);
    motions_.push_back(new_motion(frame.frame, frame.lights[d], known.value_or(velocity)));
    motions_.back().knows_start = known.has_value();
    const Vec2 before = frame.lights[d].centroid_px - velocity;
    motions_.back().track.begins_apart = std::none_of(
        last_lights_.begin(), last_lights_.end(), [&](const DetectedLight& l) { return is_within(l, before, 0.0); });
  }
}

// Lights that were not seen in this frame move on, until they have left the picture or were hidden for too long.
void LightTracker::end_lights(const FrameLights& frame) {
  for (LightMotion& motion : motions_) {
    if (motion.track.points.back().frame == frame.frame) continue;
    ++motion.missed;
    motion.position_px = motion.predicted_px;
    motion.position_frame = frame.frame;
    if (motion.missed > settings_.max_gap || is_outside(frame.picture, motion.position_px))
      ended_.push_back(motion.track);
  }
  std::erase_if(motions_, [&](const LightMotion& motion) {
    return motion.missed > settings_.max_gap || (motion.missed > 0 && is_outside(frame.picture, motion.position_px));
  });
}

void LightTracker::add(const FrameLights& frame) {
  predict(frame);
  take_pairs(frame, pair_up(frame, false));
  end_lights(frame);
  last_lights_ = frame.lights;
}

std::vector<LightTrack> LightTracker::finish() {
  for (LightMotion& motion : motions_) ended_.push_back(std::move(motion.track));
  motions_.clear();
  std::erase_if(ended_, [&](const LightTrack& track) {
    return track.points.size() < static_cast<std::size_t>(settings_.min_frames);
  });
  std::stable_sort(ended_.begin(), ended_.end(), [](const LightTrack& a, const LightTrack& b) {
    return a.points.front().frame < b.points.front().frame;
  });
  return std::move(ended_);
}

}  // namespace contrejour::inline internal
