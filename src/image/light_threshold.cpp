// What is a light and what is only lit: docs/formats/images.md, "The automatic threshold".
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "image/light_areas.h"

namespace contrejour {
namespace {

constexpr double kLeastThreshold = 1;  // white of the working space: what is darker needs no second thought
constexpr double kSurfaceShare = 0.98;  // of the pixels below the threshold are lit surfaces ...
constexpr double kLightOverSurface = 16;  // ... and a light is this much brighter than nearly all of them
constexpr double kClippedWhite = 1;  // an 8-bit picture's lights end here,
constexpr double kClippedThreshold = 0.8;  // and at the default softness count in full there
constexpr int kMostSteps = 200;

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

}  // namespace

// The least level, white or above, that leaves a gap: nearly all pixels below it are kLightOverSurface times darker.
// Found from below, so that a large lamp does not pass for a bright surface.
double automatic_threshold(const Image& rgb) {
  const Histogram histogram(rgb);
  if (histogram.largest() == kClippedWhite) return kClippedThreshold;
  double threshold = kLeastThreshold;
  for (int step = 0; step < kMostSteps && threshold < histogram.largest(); ++step) {
    const double next = kLightOverSurface * histogram.quantile_below(threshold, kSurfaceShare);
    if (!(next > threshold)) break;
    threshold = next;
  }
  return threshold;
}

}  // namespace contrejour
