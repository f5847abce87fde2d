// SPDX-License-Identifier: Apache-2.0
#include "diffraction/dirt_waves.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/scalar.h"
#include "diffraction/special_functions.h"

namespace contrejour::inline internal {
namespace {

constexpr double kSpeckWithin = 1.0;      // length of its line in widths, up to which a stroke is a speck
constexpr double kDirtFlatPhase = 0.1;        // rad: a line with a smaller phase from its curvature is straight
constexpr double kFringes = 14.0;         // rad, from which on sinc^2 and Airy's rings are replaced by their means
constexpr double kOffFan = 12.0;          // widths over lengths: angle beyond the fan from which on only ends are
                                          // counted
constexpr double kDirtSpectralBlur = 0.15;  // half of a channel's band over its middle, which blurs fringes beyond the
                                            // first
constexpr double kDirtUniformEnd = 2.5;  // Fresnel's u from which on fringes fade to their mean,
constexpr double kMeanFrom = 4.0;  // and from which on the mean is used
constexpr double kFirst = 0x1p-6;  // per mm: k of the specks' table
constexpr int kStepsPerOctave = 8;
constexpr int kOctaves = 26;
constexpr double kSizesPerOctave = 16.0;  // specks are grouped by size
constexpr double kDirtStepU = 0.5;  // of Fresnel's u in an average over directions
constexpr int kDirtMaxSteps = 8;

// (sin x / x)^2, or its mean where fringes are finer than the spectrum resolves.
double sinc_squared(double x) {
  x = std::abs(x);
  if (x < 1e-4) return 1.0;
  return x < kFringes ? square(std::sin(x) / x) : 0.5 / (x * x);
}

// (2 J1(x) / x)^2, or its mean in the same way. J1: Abramowitz & Stegun 9.4.4 and 9.4.6, to 1e-7.
double airy(double x) {
  if (x >= kFringes) return 4.0 / (kPi * x * x * x);
  const double t = square(x / 3.0);
  if (x <= 3.0) {
    const double j1_over_x =
        0.5 + t * (-0.56249985 +
                   t * (0.21093573 + t * (-0.03954289 + t * (0.00443319 + t * (-0.00031761 + t * 0.00001109)))));
    return square(2.0 * j1_over_x);
  }
  const double s = 3.0 / x;
  const double amplitude =
      0.79788456 +
      s * (0.00000156 + s * (0.01659667 + s * (0.00017105 + s * (-0.00249511 + s * (0.00113653 - s * 0.00020033)))));
  const double phase =
      x - 2.35619449 +
      s * (0.12499612 + s * (0.00005650 + s * (-0.00637879 + s * (0.00074348 + s * (0.00079824 - s * 0.00029166)))));
  return square(2.0 * amplitude * std::cos(phase) / (x * std::sqrt(x)));
}

// |integral of exp(-i pi u^2 / 2)|^2 between two points, without the fringes of its ends far from both.
double fresnel_power(double from, double to) {
  const double nearest = std::min(std::abs(from), std::abs(to));
  double exact = 0.0, mean = 0.0;
  if (nearest < kMeanFrom) {
    const FresnelIntegrals a = fresnel_integrals(from), b = fresnel_integrals(to);
    exact = square(b.c - a.c) + square(b.s - a.s);
  }
  if (nearest > kDirtUniformEnd)
    mean = (from < 0.0 && to > 0.0 ? 2.0 : 0.0) + (1.0 / square(from) + 1.0 / square(to)) / square(kPi);
  const double t = smooth_step((nearest - kDirtUniformEnd) / (kMeanFrom - kDirtUniformEnd));
  return (1.0 - t) * exact + t * mean;
}

double weight_of(const DirtStroke& s) { return square(1.0 - std::sqrt(std::max(0.0, 1.0 - s.opacity))); }

}  // namespace

DirtWaves::DirtWaves(std::span<const DirtStroke> strokes) {
  std::map<int, double> specks;  // by radius: sum of weights times areas squared, shared between the nearest two
  for (const DirtStroke& s : strokes) {
    const double area = s.width_mm * (s.length_mm + 0.25 * kPi * s.width_mm);
    if (!(area > 0.0)) continue;
    if (s.length_mm <= kSpeckWithin * s.width_mm) {
      const double size = kSizesPerOctave * 0.5 * std::log2(area / kPi);
      const double t = size - std::floor(size);
      specks[static_cast<int>(std::floor(size))] += (1.0 - t) * weight_of(s) * square(area);
      specks[static_cast<int>(std::floor(size)) + 1] += t * weight_of(s) * square(area);
    } else
      scratches_.push_back(
          {s.angle_rad + 0.5 * kPi, 0.5 * std::abs(s.bend_rad), s.length_mm, s.width_mm, weight_of(s)});
  }
  if (specks.empty()) return;
  for (int i = 0; i <= kOctaves * kStepsPerOctave; ++i) {
    const double k = kFirst * std::exp2(static_cast<double>(i) / kStepsPerOctave);
    double sum = 0.0;
    // At least as wide as a step and a channel's band, which removes the rings of single sizes.
    for (const auto& [size, power] : specks)
      for (const double turn : {-1.0, 0.0, 1.0})
        sum += power * airy(k * std::exp2(size / kSizesPerOctave + turn / (2.0 * kStepsPerOctave))) / 3.0;
    specks_.push_back(std::log2(std::max(sum, std::numeric_limits<double>::min())));
  }
}

double DirtWaves::specks_power(double k) const {
  if (specks_.empty()) return 0.0;
  const double position = std::clamp(std::log2(k / kFirst) * kStepsPerOctave, 0.0, specks_.size() - 1.001);
  const auto i = static_cast<std::size_t>(position);
  const double t = position - static_cast<double>(i);
  return std::exp2((1.0 - t) * specks_[i] + t * specks_[i + 1]);
}

std::vector<double> DirtWaves::brightest_end_normals(std::size_t scratches) const {
  std::vector<Stroke> brightest = scratches_;
  // A slit's flux across it is its width times its area.
  const auto flux = [](const Stroke& s) { return s.weight * square(s.width) * s.length; };
  std::stable_sort(brightest.begin(), brightest.end(),
                   [&](const Stroke& a, const Stroke& b) { return flux(a) > flux(b); });
  brightest.resize(std::min(brightest.size(), scratches));
  std::vector<double> normals;
  for (const Stroke& s : brightest) {
    normals.push_back(s.normal_rad - s.half_bend_rad);
    if (s.half_bend_rad > 0.0) normals.push_back(s.normal_rad + s.half_bend_rad);
  }
  return normals;
}

DirtWaves::Direction DirtWaves::along(double direction_rad, double window_rad) const {
  Direction d;
  d.waves_ = this;
  d.window_rad_ = window_rad;
  for (const Stroke& s : scratches_) {
    double tau = direction_rad - s.normal_rad;
    tau -= kPi * std::round(tau / kPi);  // u and -u give the same power
    // Outside the fan only the ends diffract light, k^-2 times that of a slit, where their fringes are fine.
    const double off_fan = std::abs(tau) - s.half_bend_rad - 0.5 * window_rad;
    const double ends = smooth_step(off_fan * s.length / (kOffFan * s.width) - 1.0);  // the weight of this term
    if (ends > 0.0) {
      // 2 / (k sin(tau))^2 * (w sinc(k w cos(tau) / 2))^2, whose mean is 4 / (k^2 sin(tau) cos(tau))^2 at large k.
      const double sine2 = square(std::sin(off_fan));
      const double cosine2 = std::max(square(std::cos(tau)), 1e-6);
      d.ends_k2_ += ends * s.weight * 2.0 * square(s.width) / sine2;
      d.ends_k4_ += ends * s.weight * 4.0 / (sine2 * cosine2);
    }
    if (ends >= 1.0) continue;
    const double radius =
        s.half_bend_rad > 0.0 ? 0.5 * s.length / s.half_bend_rad : std::numeric_limits<double>::infinity();
    const auto end = [](double angle) -> Direction::Line::End {
      const double half = 0.5 * std::clamp(angle, -kPi, kPi);
      return {std::sin(half), std::cos(half)};
    };
    d.near_.push_back({s.length, radius, s.width, (1.0 - ends) * s.weight, std::sin(tau), std::cos(tau),
                       end(tau - s.half_bend_rad), end(tau + s.half_bend_rad)});
  }
  return d;
}

// The factor of a slit's width times the one along it: for a straight slit (L sinc(k L sin(tau) / 2))^2, averaged over
// the window; for a curved one by Fresnel's integrals (EdgeWaves' arc): phase k R cos(s) = k R - (pi / 2) u^2, u =
// sqrt(4 k R / pi) sin(s / 2).
double DirtWaves::Direction::line_power(const Line& line, double k) const {
  const double across = line.weight * square(line.width) * sinc_squared(0.5 * k * line.width * line.cosine);
  if (k * square(line.length) < 8.0 * kDirtFlatPhase * line.radius) {
    const double q = 0.5 * k * line.length * line.sine;
    const double h =
        std::max(0.25 * k * line.length * line.cosine * window_rad_, kDirtSpectralBlur * (std::abs(q) - kPi));
    const double along =
        h < 0.05 ? sinc_squared(q) : (integral_of_sinc_squared(q + h) - integral_of_sinc_squared(q - h)) / (2.0 * h);
    return across * square(line.length) * along;
  }
  const double per_sine = std::sqrt(4.0 * k * line.radius / kPi);
  const int steps =
      std::clamp(static_cast<int>(std::ceil(0.5 * per_sine * window_rad_ / kDirtStepU)), 1, kDirtMaxSteps);
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double half_window = 0.5 * window_rad_ * ((i + 0.5) / steps - 0.5);  // small: a sine's tangent is the sine
    const auto u_of = [&](const Line::End& end) { return per_sine * (end.sine + half_window * end.cosine); };
    sum += fresnel_power(u_of(line.first), u_of(line.last));
  }
  return across * kPi * line.radius / k * sum / steps;
}

double DirtWaves::Direction::power(double k) const {
  double sum = waves_->specks_power(k);
  for (const Line& line : near_) sum += line_power(line, k);
  if (ends_k2_ > 0.0) sum += 1.0 / (k * k / ends_k2_ + square(k * k) / ends_k4_);
  return sum;
}

}  // namespace contrejour::inline internal
