// SPDX-License-Identifier: Apache-2.0
#include "render/bundle/band_blur.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace contrejour::inline internal::bundle {
namespace {

// A ghost that grows by more than this from band to band passes through a focus: only its centre is followed then.
constexpr double kMaxGrowth = 2.0;

double growth(double from, double to) {
  if (!(from > 0.0 && to > 0.0)) return 0.0;
  const double ratio = to / from;
  return ratio < kMaxGrowth && ratio > 1.0 / kMaxGrowth ? ratio - 1.0 : 0.0;
}

struct HalfGap {
  Vec2 shift, growth;
};

// The motion from one band half way to another.
HalfGap half_gap(const MapFigures& from, const MapFigures& to, const Frame& frame) {
  return {(frame.pixel_from_sensor(to.centre_mm) - frame.pixel_from_sensor(from.centre_mm)) * 0.5,
          Vec2{growth(from.spread_mm.x, to.spread_mm.x), growth(from.spread_mm.y, to.spread_mm.y)} * 0.5};
}

Vec2 moved(Vec2 p, Vec2 centre, Vec2 shift, Vec2 by) {
  return {p.x + shift.x + (p.x - centre.x) * by.x, p.y + shift.y + (p.y - centre.y) * by.y};
}

// The pixels of the frame that light of a box may be moved to. The motion is linear, so that the corners' ends are the
// farthest.
PixelBox reached(const PixelBox& band, const BandMotion& motion, const Frame& frame, int border) {
  Vec2 low{1e30, 1e30};
  Vec2 high{-1e30, -1e30};
  for (const int x : {band.x0 - border, band.x1 - border}) {
    for (const int y : {band.y0 - border, band.y1 - border}) {
      const Vec2 corner{static_cast<double>(x), static_cast<double>(y)};
      for (const Vec2 p : {motion.start(corner), motion.end(corner)}) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y)};
      }
    }
  }
  const auto within = [](double v, int limit) {
    return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(limit)));
  };
  return {within(std::floor(low.x), frame.width), within(std::floor(low.y), frame.height),
          within(std::ceil(high.x), frame.width), within(std::ceil(high.y), frame.height)};
}

bool is_lit(const std::optional<MapFigures>& band) { return band && band->weight > 0.0; }

}  // namespace

Vec2 BandMotion::start(Vec2 p) const { return moved(p, centre_px, to_before, growth_before); }
Vec2 BandMotion::end(Vec2 p) const { return moved(p, centre_px, to_after, growth_after); }

std::vector<std::optional<BandMotion>> band_motions(std::span<const std::optional<MapFigures>> bands,
                                                    const Frame& frame) {
  std::vector<std::optional<BandMotion>> motions(bands.size());
  for (std::size_t k = 0; k < bands.size(); ++k) {
    if (!is_lit(bands[k])) continue;
    const bool before = k > 0 && is_lit(bands[k - 1]);
    const bool after = k + 1 < bands.size() && is_lit(bands[k + 1]);
    if (!before && !after) continue;
    const HalfGap neighbour = half_gap(*bands[k], before ? *bands[k - 1] : *bands[k + 1], frame);
    const HalfGap opposite = before && after ? half_gap(*bands[k], *bands[k + 1], frame)
                                             : HalfGap{neighbour.shift * -1.0, neighbour.growth * -1.0};
    motions[k] = BandMotion{frame.pixel_from_sensor(bands[k]->centre_mm), neighbour.shift, opposite.shift,
                            neighbour.growth, opposite.growth};
  }
  return motions;
}

double longest_shift_px(const BandMotion& motion, const Frame& frame) {
  double longest = 0.0;
  for (const int x : {-frame.origin_x, frame.full_width - frame.origin_x}) {
    for (const int y : {-frame.origin_y, frame.full_height - frame.origin_y}) {
      const Vec2 corner{static_cast<double>(x), static_cast<double>(y)};
      longest = std::max({longest, length(motion.start(corner) - corner), length(motion.end(corner) - corner)});
    }
  }
  return longest;
}

FluxBox blurred(const FluxBox& band, const BandMotion& motion, const Frame& frame, const BlurOptions& options) {
  const int border = options.border;
  const PixelBox from = band.box();
  if (from.empty()) return FluxBox({});
  FluxBox out(reached(from, motion, frame, border));
  for (int y = from.y0; y < from.y1 && !options.context.cancelled(); ++y) {
    const auto row = band.row(y);
    for (int x = from.x0; x < from.x1; ++x) {
      const float flux = row[static_cast<std::size_t>(x - from.x0)];
      if (flux == 0.0F) continue;
      const Vec2 middle{x - border + 0.5, y - border + 0.5};
      out.add_line(motion.start(middle), motion.end(middle), flux);
    }
  }
  return out;
}

}  // namespace contrejour::inline internal::bundle
