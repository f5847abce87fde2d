// SPDX-License-Identifier: Apache-2.0
#include "diffraction/pixel_means.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/scalar.h"
#include "diffraction/pixel_profile.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kSameDirection = 8;  // bins that share one pixel profile
constexpr std::size_t kMaxPixelBins = 3;       // number of bins that a pixel reaches on each side of its middle

// Fractions of a pixel in strips of this width on one side of its middle: they sum to one half.
std::array<float, kMaxPixelBins> fractions_from_middle(const PixelProfile<double>& profile, double width_px) {
  std::array<float, kMaxPixelBins> fractions{};
  double below = 0.5;
  for (std::size_t k = 0; k < kMaxPixelBins; ++k) {
    const double next = k + 1 == kMaxPixelBins ? 1.0 : profile.fraction_below(static_cast<double>(k + 1) * width_px);
    fractions[k] = static_cast<float>(next - below);
    below = next;
  }
  return fractions;
}

// One row of bins, averaged over the rows that a pixel covers, if rows are narrower than pixels.
void average_rows(std::span<const float> bins_rgb0, std::size_t bins, double radius_px, std::size_t row,
                  std::vector<float>& out) {
  const double height_px = radius_px * (std::exp2(1.0 / kRowsPerOctave) - 1.0);
  const std::size_t row_size = bins * 4;
  const auto given = [&](std::size_t k) { return bins_rgb0.data() + (row + k) * row_size; };
  std::copy_n(given(kRowMargin), row_size, out.data());
  if (height_px > 1.0) return;
  for (std::size_t b = 0; b < bins; b += kSameDirection) {
    const double angle = (static_cast<double>(b) + 0.5 * kSameDirection) / static_cast<double>(bins) * kPi;
    const PixelProfile<double> profile(std::cos(angle), std::sin(angle), 1.0);
    std::array<float, 2 * kRowMargin + 1> weight{};
    double below = 0.0;
    for (std::size_t k = 0; k < weight.size(); ++k) {
      const double end = (static_cast<double>(k) + 0.5 - static_cast<double>(kRowMargin)) * height_px;
      const double next = k + 1 == weight.size() ? 1.0 : profile.fraction_below(end);
      weight[k] = static_cast<float>(next - below);
      below = next;
    }
    const std::size_t from = b * 4, end = std::min(bins, b + kSameDirection) * 4;
    for (std::size_t i = from; i < end; ++i) out[i] *= weight[kRowMargin];
    for (std::size_t k = 0; k < weight.size(); ++k)
      for (std::size_t i = from; k != kRowMargin && i < end; ++i) out[i] += weight[k] * given(k)[i];
  }
}

}  // namespace

void average_over_pixels(std::span<const float> bins_rgb0, std::size_t bins, double first_px, std::size_t row,
                         float* to) {
  const double radius_px = first_px * row_ratio(static_cast<double>(row));
  // The line is periodic, so that pixels extend beyond the first and the last bin: kMaxPixelBins more on each side.
  std::vector<float> line(bins * 4);
  average_rows(bins_rgb0, bins, radius_px, row, line);
  std::vector<float> around((bins + 2 * kMaxPixelBins) * 4);
  for (std::size_t b = 0; b < bins + 2 * kMaxPixelBins; ++b)
    std::copy_n(line.data() + (b + bins - kMaxPixelBins) % bins * 4, 4, around.data() + b * 4);
  const double width_px = radius_px * kPi / static_cast<double>(bins);
  for (std::size_t b = 0; b <= bins; b += kSameDirection) {
    const double angle = (static_cast<double>(b) + 0.5 * kSameDirection) / static_cast<double>(bins) * kPi;
    const auto fractions = fractions_from_middle(PixelProfile<double>(std::cos(angle), std::sin(angle), 1.0), width_px);
    for (std::size_t i = b * 4; i < std::min(bins + 1, b + kSameDirection) * 4; ++i) {
      const float* const middle = around.data() + kMaxPixelBins * 4 + i;
      float sum = 0.0F;
      for (std::size_t k = 0; k < kMaxPixelBins; ++k)
        sum += fractions[k] * (middle[4 * k] + *(middle - 4 * (static_cast<std::ptrdiff_t>(k) + 1)));
      to[i] = sum;
    }
  }
}

}  // namespace contrejour::inline internal
