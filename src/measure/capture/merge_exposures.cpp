// SPDX-License-Identifier: Apache-2.0
// Exposures weighted by the inverse of the variance that their merged value predicts. A variance taken from each
// exposure's own noisy value would favour values that are low by chance.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "base/tasks.h"
#include "measure/capture/half_size.h"

namespace contrejour {
namespace {

constexpr double kRounding_dn2 = 1.0 / 12.0;  // variance of a value rounded to whole DN
constexpr double kClear = 8.0;                // standard deviations above which a pixel compares exposures

// The variance of an exposure's rate at a sample of its planes, (DN / s)^2, where the true rate is this: noise of the
// photons of light and background, of reading, of rounding, and of the mean background that was subtracted.
double variance_of_rate(double rate, const HalfSize& half, std::size_t k, const SensorNoise& noise) {
  const double light = std::max(rate, 0.0) * half.time_s;
  const double ground = std::max(static_cast<double>(half.background.pixels[k]), 0.0);
  const double read_dn2 = std::pow(noise.read_electrons / noise.electrons_per_dn, 2) + kRounding_dn2;
  double variance_dn2 = (light + ground) / noise.electrons_per_dn + read_dn2;
  if (half.background_frames > 0) variance_dn2 += (ground / noise.electrons_per_dn + read_dn2) / half.background_frames;
  const double pixels = k % 3 == 1 ? 2.0 : 1.0;  // green has two
  return variance_dn2 / (pixels * half.time_s * half.time_s);
}

Result<void> check_frame(const RawFrame& frame, const RawFrame& first) {
  const bool sized = frame.width >= 2 && frame.height >= 2 && frame.width % 2 == 0 && frame.height % 2 == 0 &&
                     frame.dn.size() == static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
  if (!sized || !(frame.white_dn > frame.black_dn) || !(frame.time_s > 0.0)) {
    return invalid_argument(fmt::format("an exposure of {} x {} pixels from {:g} to {:g} DN in {:g} s cannot be merged",
                                        frame.width, frame.height, frame.black_dn, frame.white_dn, frame.time_s));
  }
  if (frame.width != first.width || frame.height != first.height || frame.pattern != first.pattern) {
    return invalid_argument("all exposures of a station need the same size and Bayer pattern");
  }
  return {};
}

Result<void> check_all(std::span<const RawFrame> exposures, std::span<const RawFrame> background,
                       const MergeSettings& settings) {
  if (exposures.empty()) return invalid_argument("there is no exposure to merge");
  for (const auto& frames : {exposures, background}) {
    for (const RawFrame& frame : frames) {
      if (Result<void> ok = check_frame(frame, exposures.front()); !ok) return ok;
    }
  }
  if (!(settings.noise.electrons_per_dn > 0.0 && settings.saturated > 0.0 && settings.saturated <= 1.0)) {
    return invalid_argument("the gain must be above 0, the saturation within 0 to 1");
  }
  if (const auto& patch = settings.monitor) {
    const bool within = patch->x >= 0 && patch->y >= 0 && patch->width > 0 && patch->height > 0 &&
                        patch->x + patch->width <= exposures.front().width &&
                        patch->y + patch->height <= exposures.front().height;
    if (!within || !(patch->rate > 0.0))
      return invalid_argument("the monitor patch must lie in the frame and have a rate");
  }
  return {};
}

// The mean rate within the monitor patch, green only, over what it should be.
double monitor_level(const HalfSize& half, const MonitorPatch& patch) {
  double sum = 0.0, count = 0.0;
  for (int y = patch.y / 2; y < std::max((patch.y + patch.height) / 2, patch.y / 2 + 1); ++y) {
    for (int x = patch.x / 2; x < std::max((patch.x + patch.width) / 2, patch.x / 2 + 1); ++x) {
      sum += static_cast<double>(half.signal.at(x, y, 1));
      ++count;
    }
  }
  return sum / (count * half.time_s * patch.rate);
}

// An exposure's rates over another's, summed where both show much more than noise; 0 where no pixel does.
double level_over(const HalfSize& a, const HalfSize& b, const SensorNoise& noise) {
  double sum_a = 0.0, sum_b = 0.0;
  for (std::size_t k = 0; k < a.signal.pixels.size(); ++k) {
    if (a.usable.pixels[k] == 0.0F || b.usable.pixels[k] == 0.0F) continue;
    const double rate_a = static_cast<double>(a.signal.pixels[k]) / a.time_s;
    const double rate_b = static_cast<double>(b.signal.pixels[k]) / b.time_s;
    const double mean = 0.5 * (rate_a + rate_b);
    const double variance = std::max(variance_of_rate(mean, a, k, noise), variance_of_rate(mean, b, k, noise));
    if (mean * mean < kClear * kClear * variance) continue;
    sum_a += rate_a;
    sum_b += rate_b;
  }
  return sum_b > 0.0 ? sum_a / sum_b : 0.0;
}

// Each exposure's level relative to the first, as far as pixels compare them: from one exposure to the next longer.
std::vector<double> levels_of(const std::vector<HalfSize>& halves, const SensorNoise& noise) {
  std::vector<double> levels(halves.size(), 1.0);
  for (std::size_t k = 1; k < halves.size(); ++k) {
    const double step = level_over(halves[k], halves[k - 1], noise);
    levels[k] = step > 0.0 ? step * levels[k - 1] : levels[k - 1];
  }
  return levels;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Leaves out exposures whose level is not the common one: a cloud went by, or the lamp flickered.
void leave_out_others(std::vector<HalfSize>& halves, const MergeSettings& settings,
                      std::vector<std::string>& warnings) {
  const std::vector<double> levels = levels_of(halves, settings.noise);
  const double usual = median(levels);
  std::vector<HalfSize> kept;
  for (std::size_t k = 0; k < halves.size(); ++k) {
    const double off = levels[k] / usual - 1.0;
    if (std::abs(off) <= settings.max_disagreement) {
      kept.push_back(std::move(halves[k]));
    } else {
      warnings.push_back(fmt::format("the exposure of {:g} s is {:+.1f} per cent off the others and was left out",
                                     halves[k].time_s, 100.0 * off));
    }
  }
  halves = std::move(kept);
}

struct MergedValue {
  double rate = 0, variance = 0;
  bool valid = true;
};

// halves: sorted by time, the shortest first.
MergedValue merged_at(const std::vector<HalfSize>& halves, std::size_t k, const SensorNoise& noise) {
  const auto rate_in = [&](const HalfSize& half) { return static_cast<double>(half.signal.pixels[k]) / half.time_s; };
  const auto longest =
      std::find_if(halves.rbegin(), halves.rend(), [&](const auto& half) { return half.usable.pixels[k] != 0.0F; });
  if (longest == halves.rend()) {
    const HalfSize& shortest = halves.front();
    return {rate_in(shortest), variance_of_rate(rate_in(shortest), shortest, k, noise), false};
  }
  const double expected = rate_in(*longest);
  double weights = 0.0, sum = 0.0;
  for (const HalfSize& half : halves) {
    if (half.usable.pixels[k] == 0.0F) continue;
    const double weight = 1.0 / variance_of_rate(expected, half, k, noise);
    weights += weight;
    sum += weight * rate_in(half);
  }
  return {sum / weights, 1.0 / weights, true};
}

}  // namespace

Result<CapturedImage> merge_exposures(std::span<const RawFrame> exposures, std::span<const RawFrame> background,
                                      const MergeSettings& settings, const Context& context) {
  if (Result<void> ok = check_all(exposures, background, settings); !ok) return tl::unexpected(ok.error());
  std::vector<HalfSize> halves(exposures.size());
  bool done = parallel_for(exposures.size(), context, [&](std::size_t k) {
    halves[k] = half_size(exposures[k], background_of_time(background, exposures[k].time_s), settings.saturated);
    if (!settings.monitor) return;
    const double level = monitor_level(halves[k], *settings.monitor);
    if (level > 0.0) halves[k].time_s *= level;
  });
  if (!done) return interrupted();
  std::ranges::sort(halves, {}, &HalfSize::time_s);
  CapturedImage image;
  leave_out_others(halves, settings, image.warnings);
  const int width = exposures.front().width / 2, height = exposures.front().height / 2;
  image.pattern = exposures.front().pattern;
  image.rate = image.variance = image.valid = Image(width, height);
  const auto row_floats = static_cast<std::size_t>(3 * width);
  done = parallel_for(static_cast<std::size_t>(height), context, [&](std::size_t y) {
    for (std::size_t k = y * row_floats; k < (y + 1) * row_floats; ++k) {
      const MergedValue value = merged_at(halves, k, settings.noise);
      image.rate.pixels[k] = static_cast<float>(value.rate);
      image.variance.pixels[k] = static_cast<float>(value.variance);
      image.valid.pixels[k] = value.valid ? 1.0F : 0.0F;
    }
  });
  if (!done) return interrupted();
  return image;
}

}  // namespace contrejour
