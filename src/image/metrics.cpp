// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/metrics.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace contrejour {
namespace {

constexpr double kPeakQuantile = 0.999;
constexpr std::size_t kFewOf = 64;

std::vector<float> finite_samples(const Image& image) {
  std::vector<float> samples;
  samples.reserve(image.pixels.size());
  for (const float value : image.pixels)
    if (std::isfinite(value)) samples.push_back(value);
  return samples;
}

double largest_finite(const Image& image) {
  double largest = 0;
  for (const float value : image.pixels)
    if (std::isfinite(value)) largest = std::max(largest, static_cast<double>(value));
  return largest;
}

double peak_of(const Image& a, const Image& b) {
  double peak = quantile_of_samples(a, kPeakQuantile);
  if (!(peak > 0)) peak = largest_finite(a);
  if (!(peak > 0)) peak = largest_finite(b);
  return peak;
}

double ratio(double b, double a) {
  if (a == 0 && b == 0) return 1;
  return a == 0 ? std::copysign(std::numeric_limits<double>::infinity(), b) : b / a;
}

// Counts by exponents, many at once.
std::size_t count_finite(std::span<const float> samples) {
  constexpr std::uint32_t kExponent = 0x7F800000U;
  std::uint32_t others = 0;  // large enough for the samples of any image
  for (const float v : samples) others += (std::bit_cast<std::uint32_t>(v) & kExponent) == kExponent ? 1U : 0U;
  return samples.size() - others;
}

// The finite samples that are at least `smallest`; most runs of samples have none and need one test.
std::vector<float> samples_from(std::span<const float> samples, float smallest) {
  constexpr std::size_t kAtOnce = 32;
  constexpr float kMaxFinite = std::numeric_limits<float>::max();
  std::vector<float> found;
  const auto keep = [&](float value) {
    if (value >= smallest && value <= kMaxFinite) found.push_back(value);
  };
  std::size_t k = 0;
  for (; k + kAtOnce <= samples.size(); k += kAtOnce) {
    int any = 0;
    for (std::size_t i = 0; i < kAtOnce; ++i) any |= samples[k + i] >= smallest ? 1 : 0;
    if (any != 0) std::ranges::for_each(samples.subspan(k, kAtOnce), keep);
  }
  std::ranges::for_each(samples.subspan(k), keep);
  return found;
}

// At least `wanted` of the largest finite samples, and not many more if every kStride-th sample estimates their lower
// end.
std::vector<float> some_of_the_largest(std::span<const float> samples, std::size_t wanted) {
  constexpr std::size_t kStride = 61;
  std::vector<float> some;
  for (std::size_t k = 0; k < samples.size(); k += kStride)
    if (std::isfinite(samples[k])) some.push_back(samples[k]);
  const std::size_t above = 2 * wanted / kStride + 8;
  if (above < some.size()) {
    const auto at = some.begin() + static_cast<std::ptrdiff_t>(above);
    std::nth_element(some.begin(), at, some.end(), std::greater<>());
    std::vector<float> found = samples_from(samples, *at);
    if (found.size() >= wanted) return found;
  }
  return samples_from(samples, std::numeric_limits<float>::lowest());
}

// The value with exactly `above` samples above it in order, and the next larger one; for the largest, itself twice.
std::pair<double, double> neighbours_below(std::vector<float>& samples, std::size_t above) {
  const auto at = samples.begin() + static_cast<std::ptrdiff_t>(above);
  std::nth_element(samples.begin(), at, samples.end(), std::greater<>());
  return {*at, above > 0 ? *std::min_element(samples.begin(), at) : *at};
}

bool same_non_finite(float a, float b) { return (std::isnan(a) && std::isnan(b)) || a == b; }

}  // namespace

double quantile_of_samples(const Image& image, double q) {
  const std::size_t count = count_finite(image.pixels);
  if (count == 0) return 0;
  const double fraction = std::isnan(q) ? 0.0 : std::clamp(q, 0.0, 1.0);
  const double position = fraction * static_cast<double>(count - 1);
  const auto below = static_cast<std::size_t>(position);
  const std::size_t above = count - 1 - below;
  std::vector<float> samples =
      above < count / kFewOf ? some_of_the_largest(image.pixels, above + 1) : finite_samples(image);
  const auto [low, high] = neighbours_below(samples, above);
  return low + (position - static_cast<double>(below)) * (high - low);
}

Result<Comparison> compare(const Image& a, const Image& b) {
  if (a.width != b.width || a.height != b.height || a.channels != b.channels)
    return failure(ErrorCode::InvalidArgument,
                   fmt::format("the images differ in size: {} x {} of {} channels, {} x {} of {}", a.width, a.height,
                               a.channels, b.width, b.height, b.channels));
  if (a.pixels.empty() || a.pixels.size() != b.pixels.size())
    return failure(ErrorCode::InvalidArgument, "there are no pixels to compare");

  Comparison result;
  result.peak = peak_of(a, b);
  const auto channels = static_cast<std::size_t>(a.channels);
  std::vector<double> sum_a(channels), sum_b(channels);
  double square_error = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const float va = a.pixels[i], vb = b.pixels[i];
    if (std::isfinite(va)) sum_a[i % channels] += va;
    if (std::isfinite(vb)) sum_b[i % channels] += vb;
    if (!std::isfinite(va) || !std::isfinite(vb)) {
      if (same_non_finite(va, vb)) continue;
      ++result.non_finite_mismatches;
      square_error += result.peak * result.peak;
      continue;
    }
    const double difference = static_cast<double>(va) - vb;
    result.max_abs_error = std::max(result.max_abs_error, std::abs(difference));
    const auto clipped = [&](double value) { return std::clamp(value, -result.peak, result.peak); };
    const double clipped_difference = clipped(va) - clipped(vb);
    square_error += clipped_difference * clipped_difference;
  }
  for (std::size_t c = 0; c < channels; ++c) result.flux_ratio.push_back(ratio(sum_b[c], sum_a[c]));
  if (square_error > 0) {
    const double mean = square_error / static_cast<double>(a.pixels.size());
    result.psnr_db = 10 * std::log10(result.peak * result.peak / mean);
  }
  return result;
}

}  // namespace contrejour
