// SPDX-License-Identifier: Apache-2.0
// The pixels of one station that a ghost reaches, with its weights there and their derivatives.
// Thread-safety: pure functions.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "contrejour/expert/measured_flare.h"

namespace contrejour::inline internal {

inline constexpr std::size_t kShapeCurves = 12;  // of curves_of(): all but the levels

inline constexpr std::size_t kPlaceCurves = 4;   // of these, those on which a point's place in a ghost depends

// A station's pixels around the optical axis. The ghosts' x axis points to the light.
struct StationFrame {
  TangentFrame pixels;
  Vec2 to_light{1.0, 0.0};  // unit, y up
  // A fit may take one pixel of `sampled_every`, evenly spread: those for which x + r y is a multiple, r the root of
  // that number and at least 2, so that the nearest of them lies about r away in every direction; and others that are
  // marked, row by row.
  int sampled_every = 1, sampled_shift = 1;
  std::shared_ptr<const std::vector<bool>> also_sampled = nullptr;

  [[nodiscard]] bool is_sampled(int x, int y) const {
    return (x + sampled_shift * y) % sampled_every == 0 ||
           (also_sampled && (*also_sampled)[static_cast<std::size_t>(y * pixels.width + x)]);
  }
};

struct GhostPixel {
  std::uint32_t index = 0;  // y * width + x
  ShadeWeights weights;
  std::array<ShadeWeights, kShapeCurves> by_shape;  // derivatives with respect to the values of curves 0..11
  Rgb inside{};  // the level that the inside's weight multiplies: the ghost's, with its profile
  std::array<Rgb, kPlaceCurves> inside_by_shape{};  // derivatives with respect to the values of curves 0..3
};

// A pixel of a ghost with a profile where the border has no part: it depends on place and size only.
struct InnerPixel {
  std::uint32_t index = 0;
  Rgb inside{};
  std::array<Rgb, kPlaceCurves> inside_by_shape{};
};

// Most pixels of a ghost lie where its shade is the inside's level alone: flat ones depend on no shape parameter, those
// of a ghost with a profile on a few.
struct GhostPixels {
  std::vector<GhostPixel> near_border;
  std::vector<InnerPixel> inner;
  std::vector<std::uint32_t> flat;  // indices
};

// The point at a pixel's middle, in the coordinates of outlines.
[[nodiscard]] Vec2 point_of(const StationFrame& frame, std::uint32_t index);

[[nodiscard]] GhostPixels ghost_pixels(const GhostAtAngle& ghost, const StationFrame& frame, bool with_derivatives);

}  // namespace contrejour::inline internal
