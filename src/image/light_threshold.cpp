// SPDX-License-Identifier: Apache-2.0
// Distinguishes lights from lit surfaces: docs/formats/images.md, "The automatic threshold".
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "image/light_areas.h"

namespace contrejour {
namespace {

constexpr double kMinThreshold = 1;  // white of the working space: darker pixels are never lights
constexpr double kSurfaceFraction = 0.98;  // of the pixels below the threshold are lit surfaces ...
constexpr double kLightOverSurface = 16;  // ... and a light is this much brighter than nearly all of them
constexpr double kClippedWhite = 1;  // an 8-bit picture's lights are clipped here,
constexpr double kClippedThreshold = 0.8;  // and at the default softness have full weight there
constexpr int kMaxSteps = 200;
constexpr double kBrightQuantile = 0.999;  // of the pixels that are not black, which excludes hot pixels
constexpr double kBelowBrightest = 4;   // two stops: panes of a window, sky beside the sun
constexpr double kMiddle = 0.5;

// Levels by the upper 16 of a float's bits: 128 bins an octave.
class Histogram {
 public:
  explicit Histogram(const Image& rgb) : counts_(kBins) {
    for (std::size_t i = 0; i + 2 < rgb.pixels.size(); i += 3) {
      const float level = level_of(rgb.pixels.data() + i);
      ++counts_[std::bit_cast<std::uint32_t>(level) >> kShift];
      largest_ = std::max(largest_, level);
    }
  }

  [[nodiscard]] double largest() const { return largest_; }

  // The level that a fraction 1 - q of the pixels that are not black exceeds.
  [[nodiscard]] double quantile_of_lit(double q) const {
    double lit = 0;
    for (std::size_t i = 1; i < kBins; ++i) lit += static_cast<double>(counts_[i]);
    double above = (1.0 - q) * lit;
    for (std::size_t i = kBins - 1; i > 0; --i) {
      above -= static_cast<double>(counts_[i]);
      if (above < 0) return std::min(largest(), edge(i + 1));
    }
    return 0;
  }

  // Quantile of the pixels below a level, linear within a bin.
  [[nodiscard]] double quantile_below(double level, double q) const {
    const double target = q * count_below(level);
    double count = 0;
    for (std::size_t i = 0; i < kBins; ++i) {
      const auto bin = static_cast<double>(counts_[i]);
      if (bin > 0 && count + bin >= target)
        return std::min(level, edge(i) + (target - count) / bin * (edge(i + 1) - edge(i)));
      count += bin;
    }
    return 0;
  }

 private:
  static constexpr unsigned kShift = 16;
  static constexpr std::size_t kBins = 0x7f80;  // finite and positive

  static double edge(std::size_t bin) {
    if (bin == 0) return 0;
    if (bin >= kBins) return static_cast<double>(std::numeric_limits<float>::max());
    return static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(bin) << kShift));
  }

  [[nodiscard]] double count_below(double level) const {
    double count = 0;
    for (std::size_t i = 0; i < kBins && edge(i) < level; ++i) {
      const double part = std::min(1.0, (level - edge(i)) / (edge(i + 1) - edge(i)));
      count += part * static_cast<double>(counts_[i]);
    }
    return count;
  }

  std::vector<std::uint64_t> counts_;
  float largest_ = 0;
};

double threshold_of_brightest(const Histogram& histogram) {
  return histogram.quantile_of_lit(kBrightQuantile) / kBelowBrightest;
}

}  // namespace

// The lowest level, white or above, that leaves a gap: nearly all pixels below it are kLightOverSurface times darker.
// The search starts from below, so that a large lamp is not taken for a bright surface.
Threshold automatic_threshold(const Image& rgb) {
  const Histogram histogram(rgb);
  if (histogram.largest() == kClippedWhite) return {kClippedThreshold, ThresholdSource::Clipped};
  double threshold = kMinThreshold;
  for (int step = 0; step < kMaxSteps && threshold < histogram.largest(); ++step) {
    const double next = kLightOverSurface * histogram.quantile_below(threshold, kSurfaceFraction);
    if (!(next > threshold)) break;
    threshold = next;
  }
  if (threshold < histogram.largest()) return {threshold, ThresholdSource::Gap};
  const double level = std::max(kMinThreshold, threshold_of_brightest(histogram));
  const bool stands_out = level < histogram.largest() &&
                          kBelowBrightest * level >= kLightOverSurface * histogram.quantile_below(level, kMiddle);
  if (stands_out) return {level, ThresholdSource::Brightest};
  return {threshold > histogram.largest() ? threshold : std::nextafter(threshold, 2.0 * threshold),
          ThresholdSource::None};
}

}  // namespace contrejour

namespace contrejour::inline internal {

double threshold_of_brightest(const Image& rgb) { return threshold_of_brightest(Histogram(rgb)); }

}  // namespace contrejour::inline internal
