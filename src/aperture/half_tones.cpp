// SPDX-License-Identifier: Apache-2.0
#include "aperture/half_tones.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal {
namespace {

constexpr float kGreyFrom = 0.1F, kGreyTo = 0.9F;  // of the highest level
// Corners and thin lines have pixels that look like half-tones: up to this number, or this fraction of the stop's
// pixels, a picture still counts as a mask.
constexpr int kFewHalfTones = 4;
constexpr double kFewHalfTonesFraction = 2e-3;
constexpr int kParts = 8;  // of a sample, each way, where the rim crosses it

// The fraction of a sample within the rim, by the middles of its parts.
double fraction_within_rim(Vec2 low, double pitch) {
  const Vec2 far{std::max(std::abs(low.x), std::abs(low.x + pitch)),
                 std::max(std::abs(low.y), std::abs(low.y + pitch))};
  if (dot(far, far) <= 1.0) return 1.0;
  int within = 0;
  for (int j = 0; j < kParts; ++j)
    for (int i = 0; i < kParts; ++i) within += length(low + Vec2{i + 0.5, j + 0.5} * (pitch / kParts)) <= 1.0 ? 1 : 0;
  return static_cast<double>(within) / (kParts * kParts);
}

}  // namespace

bool contains_half_tones(std::span<const float> level, int width, int height, float highest) {
  const auto at = [&](int x, int y) {
    return level[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  };
  const float dark = kGreyFrom * highest, bright = kGreyTo * highest;
  const double middle_x = 0.5 * width, middle_y = 0.5 * height, radius = 0.5 * std::max(width, height);
  int half_tones = 0;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      if (!(at(x, y) > dark && at(x, y) < bright)) continue;
      if (std::hypot(x + 0.5 - middle_x, y + 0.5 - middle_y) > radius) continue;
      bool has_dark = false, has_bright = false;
      for (int v = std::max(y - 1, 0); v <= std::min(y + 1, height - 1); ++v) {
        for (int u = std::max(x - 1, 0); u <= std::min(x + 1, width - 1); ++u) {
          has_dark = has_dark || at(u, v) <= dark;
          has_bright = has_bright || at(u, v) >= bright;
        }
      }
      half_tones += has_dark && has_bright ? 0 : 1;
    }
  }
  return half_tones > std::max(static_cast<double>(kFewHalfTones), kFewHalfTonesFraction * radius * radius);
}

HalfTones::HalfTones(const StopSamples& samples, float highest) : side_(samples.side - 2) {
  const auto corners = static_cast<std::size_t>(side_) + 1;
  sums_.assign(corners * corners, 0.0);
  const double pitch = 2.0 / side_;
  for (int j = 0; j < side_; ++j) {
    double row = 0.0;
    for (int i = 0; i < side_; ++i) {
      const float level = samples.value[samples.at(i + 1, j + 1)] / highest;
      const double passed = level < kDark ? 0.0 : std::min(level, 1.0F);
      row += passed;
      const std::size_t corner = (static_cast<std::size_t>(j) + 1) * corners + static_cast<std::size_t>(i) + 1;
      sums_[corner] = sums_[corner - corners] + row;
      if (passed > 0.0)
        flux_ += passed * pitch * pitch * fraction_within_rim({i * pitch - 1.0, j * pitch - 1.0}, pitch);
    }
  }
}

// Bilinear between corners, which is exact because samples are constant.
double HalfTones::sum_to(double column, double row) const {
  const int i = std::min(static_cast<int>(column), side_ - 1), j = std::min(static_cast<int>(row), side_ - 1);
  const auto corners = static_cast<std::size_t>(side_) + 1;
  const double* at = sums_.data() + static_cast<std::size_t>(j) * corners + static_cast<std::size_t>(i);
  return std::lerp(std::lerp(at[0], at[1], column - i), std::lerp(at[corners], at[corners + 1], column - i), row - j);
}

double HalfTones::mean(Vec2 p, double width) const {
  const double scale = 0.5 * side_, half = 0.5 * std::max(width * scale, 1.0);
  const auto range = [&](double middle) {
    const double low = std::clamp(middle - half, 0.0, static_cast<double>(side_));
    return std::pair(low, std::clamp(middle + half, 0.0, static_cast<double>(side_)));
  };
  const auto [left, right] = range((p.x + 1.0) * scale);
  const auto [low, high] = range((p.y + 1.0) * scale);
  const double area = (right - left) * (high - low);
  if (!(area > 0.0)) return 0.0;
  const double sum = sum_to(right, high) - sum_to(left, high) - sum_to(right, low) + sum_to(left, low);
  return std::clamp(sum / area, 0.0, 1.0);
}

}  // namespace contrejour::inline internal
