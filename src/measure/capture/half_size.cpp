// SPDX-License-Identifier: Apache-2.0
#include "measure/capture/half_size.h"

#include <algorithm>
#include <cmath>

#include "measure/capture/bayer.h"

namespace contrejour::inline internal {
namespace {

constexpr double kSameTime = 1e-3;  // relative

// Clears what is within one pixel of a saturated one: charge may have spilled over.
Image cleared_around(const Image& usable) {
  Image kept = usable;
  for (int y = 0; y < usable.height; ++y) {
    for (int x = 0; x < usable.width; ++x) {
      for (int c = 0; c < 3; ++c) {
        if (usable.at(x, y, c) != 0.0F) continue;
        for (int v = std::max(y - 1, 0); v <= std::min(y + 1, usable.height - 1); ++v) {
          for (int u = std::max(x - 1, 0); u <= std::min(x + 1, usable.width - 1); ++u) kept.at(u, v, c) = 0.0F;
        }
      }
    }
  }
  return kept;
}

}  // namespace

HalfSize half_size(const RawFrame& frame, const Background& background, double saturated) {
  const int width = frame.width / 2, height = frame.height / 2;
  HalfSize half{Image(width, height), Image(width, height), background.frames, Image(width, height), frame.time_s};
  std::fill(half.usable.pixels.begin(), half.usable.pixels.end(), 1.0F);
  const double limit = frame.black_dn + saturated * (frame.white_dn - frame.black_dn);
  const auto channels = channels_of(frame.pattern);
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const auto k = static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(x);
      const auto c = static_cast<int>(channels[static_cast<std::size_t>(2 * (y % 2) + x % 2)]);
      const double dn = frame.dn[k];
      const double ground = background.dn.empty() ? frame.black_dn : static_cast<double>(background.dn[k]);
      const double part = c == 1 ? 0.5 : 1.0;
      half.signal.at(x / 2, y / 2, c) += static_cast<float>(part * (dn - ground));
      half.background.at(x / 2, y / 2, c) += static_cast<float>(part * (ground - frame.black_dn));
      if (dn >= limit) half.usable.at(x / 2, y / 2, c) = 0.0F;
    }
  }
  half.usable = cleared_around(half.usable);
  return half;
}

Background background_of_time(std::span<const RawFrame> frames, double time_s) {
  Background mean;
  for (const RawFrame& frame : frames) {
    if (std::abs(frame.time_s - time_s) > kSameTime * time_s) continue;
    mean.dn.resize(frame.dn.size(), 0.0F);
    for (std::size_t k = 0; k < mean.dn.size(); ++k) mean.dn[k] += static_cast<float>(frame.dn[k]);
    ++mean.frames;
  }
  for (float& level : mean.dn) level /= static_cast<float>(mean.frames);
  return mean;
}

}  // namespace contrejour::inline internal
