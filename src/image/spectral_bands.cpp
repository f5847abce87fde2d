// SPDX-License-Identifier: Apache-2.0
// The visible spectrum in N bands: docs/physics/colour.md.
#include <algorithm>
#include <cmath>

#include "image/cie_tables.h"
#include "image/rgb_spaces.h"

namespace contrejour {
namespace {

// Below this fraction of its absolute integral a channel's total does not describe the distribution of its light: the
// blue matching function's lobes cancel for a black body of about 1900 K, and the quotient would be unbounded.
constexpr double kMinTotalFraction = 0.25;

// The quantities integrated over wavelength, piecewise linear between whole nanometres.
struct Sample {
  double visible = 0;  // S (xbar + ybar + zbar)
  double moment = 0;   // lambda times that
  double second = 0;   // and again
  Rgb channel{};       // S times the channel's matching function
  Rgb absolute{};      // and its size
};

Sample operator+(const Sample& a, const Sample& b) {
  Sample sum{a.visible + b.visible, a.moment + b.moment, a.second + b.second, {}, {}};
  for (std::size_t c = 0; c < 3; ++c) {
    sum.channel[c] = a.channel[c] + b.channel[c];
    sum.absolute[c] = a.absolute[c] + b.absolute[c];
  }
  return sum;
}

Sample operator*(double s, const Sample& a) {
  Sample scaled{s * a.visible, s * a.moment, s * a.second, {}, {}};
  for (std::size_t c = 0; c < 3; ++c) {
    scaled.channel[c] = s * a.channel[c];
    scaled.absolute[c] = s * a.absolute[c];
  }
  return scaled;
}

constexpr int kMaxBands = 100000;

// Several bands of one spectral line may be at the same whole nanometre; their wavelengths are separated by this, as no
// two may be equal.
constexpr double kMaxSpacing_nm = 1e-6;

using Samples = std::array<Sample, cie::kObserverCount>;

Samples sample_light(const Spectrum& light, ColourSpace space) {
  // A black body of 500 K spans 17 powers of ten; relative to its largest value no over- or underflow matters.
  std::array<double, cie::kObserverCount> power{};
  double largest = 0;
  for (std::size_t i = 0; i < power.size(); ++i) {
    power[i] = spectral_power_near(light, cie::kObserverFirstNm + static_cast<double>(i));
    largest = std::max(largest, power[i]);
  }
  Samples samples{};
  for (std::size_t i = 0; i < power.size(); ++i) {
    const Xyz& observer = cie::kObserver1931[i];
    const Rgb matching = rgb_from_xyz(observer, space);
    const double s = power[i] / largest;
    samples[i].visible = s * (observer[0] + observer[1] + observer[2]);
    samples[i].moment = samples[i].visible * (cie::kObserverFirstNm + static_cast<double>(i));
    samples[i].second = samples[i].moment * (cie::kObserverFirstNm + static_cast<double>(i));
    for (std::size_t c = 0; c < 3; ++c) {
      samples[i].channel[c] = s * matching[c];
      samples[i].absolute[c] = std::abs(s * matching[c]);
    }
  }
  return samples;
}

// Integrals from the first wavelength to any other, exact for the piecewise linear samples.
class Cumulative {
 public:
  explicit Cumulative(const Samples& samples) : samples_(samples) {
    for (std::size_t i = 1; i < samples.size(); ++i) to_[i] = to_[i - 1] + 0.5 * (samples[i - 1] + samples[i]);
  }

  [[nodiscard]] const Sample& total() const { return to_.back(); }

  // The integrals up to the wavelength where `visible` reaches this value. Within a nanometre visible is
  // v0 t + (v1 - v0) t^2 / 2; the root is taken in the form that does not cancel.
  [[nodiscard]] Sample up_to_visible(double value) const {
    const auto above = std::upper_bound(to_.begin() + 1, to_.end() - 1, value,
                                        [](double v, const Sample& s) { return v < s.visible; });
    const auto i = static_cast<std::size_t>(above - to_.begin()) - 1;
    const double rest = std::max(0.0, value - to_[i].visible);
    const double v0 = samples_[i].visible, slope = samples_[i + 1].visible - v0;
    const double denominator = v0 + std::sqrt(std::max(0.0, v0 * v0 + 2 * slope * rest));
    const double t = denominator > 0 ? std::min(1.0, 2 * rest / denominator) : 0.0;
    return to_[i] + (t - 0.5 * t * t) * samples_[i] + (0.5 * t * t) * samples_[i + 1];
  }

 private:
  const Samples& samples_;
  Samples to_{};
};

// Weights as multiples of this add up without rounding, in any order; it is far below the tables' own digits.
constexpr double kWeightStep = 0x1p-48;

void make_sum_one(std::vector<SpectralBand>& bands, std::size_t c) {
  double sum = 0;
  SpectralBand* largest = &bands.front();
  for (SpectralBand& band : bands) {
    band.weight[c] = std::nearbyint(band.weight[c] / kWeightStep) * kWeightStep;
    sum += band.weight[c];
    if (std::abs(band.weight[c]) > std::abs(largest->weight[c])) largest = &band;
  }
  largest->weight[c] += 1 - sum;
}

}  // namespace

std::vector<SpectralBand> spectral_bands(int count, const Spectrum& light, ColourSpace space) {
  if (count < 1 || count > kMaxBands) return {};
  const Samples samples = sample_light(light, space);
  const Cumulative cumulative(samples);
  const Sample& total = cumulative.total();

  std::vector<SpectralBand> bands(static_cast<std::size_t>(count));
  Sample begin{};
  for (std::size_t k = 0; k < bands.size(); ++k) {
    const bool last = k + 1 == bands.size();
    const double fraction = static_cast<double>(k + 1) / static_cast<double>(bands.size());
    const Sample end = last ? total : cumulative.up_to_visible(fraction * total.visible);
    const Sample band = end + (-1.0) * begin;
    bands[k].lambda_nm = band.moment / band.visible;
    if (k > 0) bands[k].lambda_nm = std::max(bands[k].lambda_nm, bands[k - 1].lambda_nm + kMaxSpacing_nm);
    bands[k].spread_nm = std::sqrt(std::max(0.0, band.second / band.visible - bands[k].lambda_nm * bands[k].lambda_nm));
    for (std::size_t c = 0; c < 3; ++c) {
      // The channel's own integral, plus enough of the absolute one to keep the quotient bounded.
      const double added = std::max(0.0, kMinTotalFraction - total.channel[c] / total.absolute[c]);
      bands[k].weight[c] =
          (band.channel[c] + added * band.absolute[c]) / (total.channel[c] + added * total.absolute[c]);
    }
    begin = end;
  }
  for (std::size_t c = 0; c < 3; ++c) make_sum_one(bands, c);
  return bands;
}

}  // namespace contrejour
