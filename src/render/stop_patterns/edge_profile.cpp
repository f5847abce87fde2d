// SPDX-License-Identifier: Apache-2.0
#include "render/stop_patterns/edge_profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/scalar.h"

namespace contrejour::inline internal::stop_patterns {
namespace {

constexpr double kStep = 1.0 / 128.0;  // a fringe at t = 32 is eight of them
constexpr double kShadowTaper = 1.5, kLightTaper = 8.0;  // where the table fades to its ends
constexpr int kBandSamples = 33;
constexpr double kCorrectedOver = 8.0;  // width on the light's side to which the light beyond the ends is added

// Computes |U|^2 at one wavelength: 1/2 ((C + 1/2)^2 + (S + 1/2)^2), with the integrals summed step by step (Born &
// Wolf 8.7.3).
class OneWavelength {
 public:
  OneWavelength(double first, double last) : first_(first) {
    const auto steps = static_cast<std::size_t>((last - first) / kFine) + 2;
    std::vector<double> c(steps), s(steps);
    for (std::size_t k = 1; k < steps; ++k) {
      const Pair part = integral(first + static_cast<double>(k - 1) * kFine);
      c[k] = c[k - 1] + part.c;
      s[k] = s[k - 1] + part.s;
    }
    const auto zero = static_cast<std::size_t>(std::lround(-first / kFine));
    for (std::size_t k = 0; k < steps; ++k) {
      const double re = c[k] - c[zero] + 0.5, im = s[k] - s[zero] + 0.5;
      value_.push_back(0.5 * (re * re + im * im));
    }
  }

  [[nodiscard]] double at(double t) const {
    const double position = std::clamp((t - first_) / kFine, 0.0, static_cast<double>(value_.size()) - 1.001);
    const auto k = static_cast<std::size_t>(position);
    return std::lerp(value_[k], value_[k + 1], position - static_cast<double>(k));
  }

 private:
  static constexpr double kFine = 1.0 / 512.0;
  struct Pair {
    double c, s;
  };
  // Integrates exp(i pi t^2 / 2) over one step by Simpson's rule; the phase changes by 0.1 at most.
  static Pair integral(double t) {
    const auto phase = [](double x) { return 0.5 * kPi * x * x; };
    const double a = phase(t), m = phase(t + 0.5 * kFine), b = phase(t + kFine);
    return {kFine / 6.0 * (std::cos(a) + 4.0 * std::cos(m) + std::cos(b)),
            kFine / 6.0 * (std::sin(a) + 4.0 * std::sin(m) + std::sin(b))};
  }

  double first_;
  std::vector<double> value_;
};

}  // namespace

// F varies as 1 / lambda, and t as its root.
EdgeProfile::EdgeProfile(double spread) {
  const double half_band = std::min(std::numbers::sqrt3 * spread, 0.9);  // of a uniform band with that spread
  const double widest = 1.0 / std::sqrt(1.0 - half_band);
  const OneWavelength one(std::floor(kDarkBelow * widest), kLevelAbove * widest);
  const int samples = half_band > 0.0 ? kBandSamples : 1;
  const auto count = static_cast<std::size_t>((kLevelAbove - kDarkBelow) / kStep) + 1;
  double excess = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    const double t = kDarkBelow + static_cast<double>(k) * kStep;
    double mean = 0.0;
    for (int j = 0; j < samples; ++j) {
      const double lambda = 1.0 + half_band * ((2.0 * j + 1.0) / samples - 1.0);
      mean += one.at(t / std::sqrt(lambda)) / samples;
    }
    const double lit = t < 0.0 ? 0.0 : 1.0;
    const double kept = smooth_step((t - kDarkBelow) / kShadowTaper) * smooth_step((kLevelAbove - t) / kLightTaper);
    value_.push_back(std::lerp(lit, mean, kept));
    excess += (value_.back() - (t == 0.0 ? 0.5 : lit)) * kStep;
  }
  // An edge displaces light and absorbs none: the excess that the ends cut off is spread over the light next to it.
  for (std::size_t k = 0; k < count; ++k) {
    const double t = kDarkBelow + static_cast<double>(k) * kStep;
    if (t > 0.0 && t < kCorrectedOver)
      value_[k] -= excess / kCorrectedOver * 2.0 * std::pow(std::sin(kPi * t / kCorrectedOver), 2);
  }
  worst_from_.assign(count + 1, 0.0);
  for (std::size_t k = count; k-- > 0;) worst_from_[k] = std::max(worst_from_[k + 1], std::abs(value_[k] - 1.0));
  for (const double v : value_) brightest_to_.push_back(brightest_to_.empty() ? v : std::max(brightest_to_.back(), v));
  error_to_.assign(count, 0.0);
  error_from_.assign(count, 0.0);
  for (std::size_t k = 1; k < count; ++k) error_to_[k] = error_to_[k - 1] + value_[k - 1] * value_[k - 1] * kStep;
  for (std::size_t k = count - 1; k-- > 0;)
    error_from_[k] = error_from_[k + 1] + (value_[k] - 1.0) * (value_[k] - 1.0) * kStep;
  integral_.push_back(0.0);
  for (std::size_t k = 1; k < count; ++k)
    integral_.push_back(integral_.back() + 0.5 * kStep * (value_[k - 1] + value_[k]));
}

EdgeProfile::Range EdgeProfile::range_above(double ripple) const {
  const auto dark = std::upper_bound(brightest_to_.begin(), brightest_to_.end(), ripple);
  return {std::min(kDarkBelow + static_cast<double>(dark - brightest_to_.begin()) * kStep, 0.0),
          std::max(level_above(ripple), 0.0)};
}

double EdgeProfile::squared_error(Range range) const {
  const auto at = [](double t) {
    return static_cast<std::size_t>(std::lround((std::clamp(t, kDarkBelow, kLevelAbove) - kDarkBelow) / kStep));
  };
  return error_to_[at(range.dark)] + error_from_[at(range.level)];
}

double EdgeProfile::at(double t, double width) const {
  if (t + 0.5 * width <= kDarkBelow) return 0.0;
  if (t - 0.5 * width >= kLevelAbove) return 1.0;
  const auto between = [](const std::vector<double>& table, double position) {
    const auto k = std::min(static_cast<std::size_t>(position), table.size() - 2);
    return table[k] + (table[k + 1] - table[k]) * (position - static_cast<double>(k));
  };
  if (width < kStep)
    return between(value_, std::clamp((t - kDarkBelow) / kStep, 0.0, static_cast<double>(value_.size()) - 1.0));
  const auto integral_to = [&](double end) {
    if (end <= kDarkBelow) return 0.0;
    if (end >= kLevelAbove) return integral_.back() + end - kLevelAbove;
    return between(integral_, (end - kDarkBelow) / kStep);
  };
  return (integral_to(t + 0.5 * width) - integral_to(t - 0.5 * width)) / width;
}

double EdgeProfile::level_above(double tolerance) const {
  const auto first =
      std::partition_point(worst_from_.begin(), worst_from_.end(), [&](double w) { return w > tolerance; });
  return kDarkBelow + static_cast<double>(first - worst_from_.begin()) * kStep;
}

}  // namespace contrejour::inline internal::stop_patterns
