// SPDX-License-Identifier: Apache-2.0
#include "studio/core/measured_sweep.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contrejour/expert/settings.h"

namespace contrejour::studio {
namespace {

constexpr int kMostSamples = 16;  // along a pixel's side

// The directions, in pixels with y down, in which the light goes and that perpendicular to it.
struct LightAxes {
  Vec2 along, across;
};

LightAxes axes_of(const SweepGeometry& geometry) {
  const double c = std::cos(geometry.roll_rad), s = std::sin(geometry.roll_rad);
  return {{c, -s}, {-s, -c}};
}

}  // namespace

Image in_frame(const Image& picture, const SweepGeometry& geometry, const TangentFrame& frame) {
  const LightAxes axes = axes_of(geometry);
  const double scale = geometry.focal_length_px / frame.focal_length_px;  // of the picture's pixels per frame's
  const int samples = std::clamp(static_cast<int>(std::ceil(std::fabs(scale))), 1, kMostSamples);
  const double area = scale * scale / (samples * samples);
  Image out(frame.width, frame.height);
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x)
      for (int k = 0; k < samples * samples; ++k) {
        const double right = x + (k % samples + 0.5) / samples - frame.centre_px.x;
        const double up = frame.centre_px.y - y - (k / samples + 0.5) / samples;
        const Vec2 at = geometry.centre_px + axes.along * (scale * right) + axes.across * (scale * up);
        const int px = static_cast<int>(std::floor(at.x)), py = static_cast<int>(std::floor(at.y));
        if (px < 0 || py < 0 || px >= picture.width || py >= picture.height) continue;
        for (int c = 0; c < 3; ++c) out.at(x, y, c) += static_cast<float>(area) * picture.at(px, py, c);
      }
  return out;
}

Result<MeasuredSweep> MeasuredSweep::open(const std::string& folder) {
  auto merged = open_merged(folder);
  if (!merged) return tl::unexpected(merged.error());
  const auto geometry = geometry_of(*merged, folder);
  if (!geometry) return tl::unexpected(geometry.error());
  MeasuredSweep sweep;
  double count = 0;
  for (const auto& direct : merged->direct) {
    if (!direct) continue;
    count += 1;
    for (std::size_t c = 0; c < 3; ++c) sweep.usual_light_[c] += direct->rate[c];
  }
  for (double& rate : sweep.usual_light_) rate /= count;  // geometry_of() has found some
  sweep.folder_ = folder;
  sweep.merged_ = std::move(*merged);
  sweep.geometry_ = *geometry;
  return sweep;
}

double MeasuredSweep::angle_deg(std::size_t station) const {
  return std::atan(light(station).position.x) / params::kDegree_rad;
}

std::size_t MeasuredSweep::nearest(double angle_deg) const {
  std::size_t best = 0;
  for (std::size_t k = 1; k < count(); ++k)
    if (std::fabs(this->angle_deg(k) - angle_deg) < std::fabs(this->angle_deg(best) - angle_deg)) best = k;
  return best;
}

FlareLight MeasuredSweep::light(std::size_t station) const {
  const auto& direct = merged_.direct[station];
  const Vec2 at = direct ? direct->position_px : geometry_.position_of(merged_.angles_rad[station]);
  const Vec2 from_axis = at - geometry_.centre_px, along = axes_of(geometry_).along;
  return {{(from_axis.x * along.x + from_axis.y * along.y) / geometry_.focal_length_px, 0}, {1, 1, 1}};
}

Result<std::shared_ptr<const Image>> MeasuredSweep::picture(std::size_t station) {
  const auto found = std::ranges::find(kept_, station, &Kept::station);
  if (found != kept_.end()) return found->picture;
  auto captured = merged_.sweep().picture(station);
  if (!captured) return tl::unexpected(captured.error());
  const auto& direct = merged_.direct[station];
  const Rgb& light = direct ? direct->rate : usual_light_;
  Image& rate = captured->rate;
  for (std::size_t k = 0; k < rate.pixels.size(); ++k)
    rate.pixels[k] = static_cast<float>(static_cast<double>(rate.pixels[k]) / light[k % 3]);
  if (kept_.size() >= kMostKept) kept_.erase(kept_.begin());
  kept_.push_back({station, std::make_shared<const Image>(std::move(rate))});
  return kept_.back().picture;
}

Result<Image> MeasuredSweep::photograph(std::size_t station, const TangentFrame& frame) {
  const auto whole = picture(station);
  if (!whole) return tl::unexpected(whole.error());
  return in_frame(**whole, geometry_, frame);
}

}  // namespace contrejour::studio
