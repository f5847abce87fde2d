// SPDX-License-Identifier: Apache-2.0
#include "render/radiometry/direct_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "base/tasks.h"
#include "render/pupils/direct_meter.h"
#include "render/radiometry/wavelength_samples.h"

namespace contrejour::inline internal {
namespace {

// The numbers of bands that are measured, round by round, where there are many bands: at first six and a seventh to
// test whether the six predict it; then more, until those before the last predict the last.
constexpr std::array<std::size_t, 3> kSamples{7, 10, 13};
constexpr std::size_t kManyBands = 16;  // with fewer, all are measured
constexpr double kPredictionTolerance = 2e-4;  // relative to the largest flux

// The bands to sample where there are many; an empty set where there are few, which means that all are measured.
WavelengthSamples samples_of(std::span<const SpectralBand> bands) {
  std::vector<double> lambda_nm;
  for (const SpectralBand& band : bands) lambda_nm.push_back(band.lambda_nm);
  WavelengthSamples samples(lambda_nm, bands.size() >= kManyBands ? kSamples.back() : 0);
  return samples.size() == kSamples.back() ? samples : WavelengthSamples({}, 0);
}

double predicted(const MeteredLight& light, const WavelengthSamples& samples, std::size_t count, std::size_t band) {
  const std::vector<double> factors = samples.factors(count, band);
  double flux = 0.0;
  for (std::size_t k = 0; k < count; ++k) flux += factors[k] * light.flux_mm2[samples[k]];
  return flux;
}

// Whether the fluxes of the first `count` - 1 samples predict that of the next one.
bool predicts_last(const MeteredLight& light, const WavelengthSamples& samples, std::size_t count) {
  double largest = 0.0;
  for (std::size_t k = 0; k < count; ++k) largest = std::max(largest, light.flux_mm2[samples[k]]);
  const std::size_t last = samples[count - 1];
  return std::abs(predicted(light, samples, count - 1, last) - light.flux_mm2[last]) <= kPredictionTolerance * largest;
}

// Measures one light's fluxes, round by round.
class LightMeter {
 public:
  LightMeter(const LensState& lens, MeteredLight& light)
      : light_(light), meter_(lens, light.source), samples_(samples_of(light.bands)) {
    light.flux_mm2.assign(light.bands.size(), 0.0);
  }

  // The pupil of the middle wavelength is used for all others: if no light of the middle wavelength gets through,
  // hardly any of the others does.
  void find_pupil(const TablesByWavelength& tables) {
    pupil_ = meter_.pupil(tables.at(light_.bands[light_.bands.size() / 2].lambda_nm));
  }

  // The bands to measure next; empty once all fluxes are known.
  [[nodiscard]] std::vector<std::size_t> next_bands() const {
    std::vector<std::size_t> next;
    if (is_done_) return next;
    if (samples_.size() > 0 && round_ < kSamples.size()) {
      for (std::size_t k = measured(); k < kSamples[round_]; ++k) next.push_back(samples_[k]);
      return next;
    }
    std::vector<bool> known(light_.bands.size(), false);
    for (std::size_t k = 0; k < measured(); ++k) known[samples_[k]] = true;
    for (std::size_t band = 0; band < known.size(); ++band)
      if (!known[band]) next.push_back(band);
    return next;
  }

  void measure(std::size_t band, const TablesByWavelength& tables) {
    light_.flux_mm2[band] = pupil_ ? meter_.flux_mm2(tables.at(light_.bands[band].lambda_nm), *pupil_) : 0.0;
  }

  // Is called once all next_bands() are measured.
  void end_round() {
    const bool all = samples_.size() == 0 || round_ == kSamples.size();
    if (!all && predicts_last(light_, samples_, kSamples[round_])) interpolate_others(kSamples[round_]);
    is_done_ = is_done_ || all;
    ++round_;
  }

 private:
  [[nodiscard]] std::size_t measured() const { return samples_.size() > 0 && round_ > 0 ? kSamples[round_ - 1] : 0; }

  void interpolate_others(std::size_t count) {
    const std::vector<double> measured = light_.flux_mm2;
    std::vector<double> fluxes(measured.size());
    for (std::size_t band = 0; band < fluxes.size(); ++band)
      fluxes[band] = std::max(0.0, predicted(light_, samples_, count, band));
    for (std::size_t k = 0; k < count; ++k) fluxes[samples_[k]] = measured[samples_[k]];
    light_.flux_mm2 = fluxes;
    is_done_ = true;
  }

  MeteredLight& light_;
  DirectMeter meter_;
  WavelengthSamples samples_;  // empty: all bands are measured
  std::optional<Rectangle> pupil_;
  std::size_t round_ = 0;
  bool is_done_ = false;
};

}  // namespace

std::vector<std::size_t> measured_first(std::span<const SpectralBand> bands) {
  const WavelengthSamples samples = samples_of(bands);
  std::vector<std::size_t> first{bands.size() / 2};
  const std::size_t count = samples.size() > 0 ? kSamples.front() : bands.size();
  for (std::size_t k = 0; k < count; ++k) first.push_back(samples.size() > 0 ? samples[k] : k);
  return first;
}

bool measure_fluxes(const LensState& lens, const TablesByWavelength& tables, KeptFluxes& kept,
                    std::span<MeteredLight> lights, const Context& context) {
  std::vector<LightMeter> meters;
  meters.reserve(lights.size());
  for (MeteredLight& light : lights) {
    if (auto known = kept.find(light.source, light.bands))
      light.flux_mm2 = *std::move(known);
    else
      meters.emplace_back(lens, light);
  }
  if (!parallel_for(meters.size(), context, [&](std::size_t k) { meters[k].find_pupil(tables); })) return false;
  while (true) {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;  // indices of light and band
    for (std::size_t k = 0; k < meters.size(); ++k)
      for (const std::size_t band : meters[k].next_bands()) pairs.emplace_back(k, band);
    if (pairs.empty()) break;
    if (!parallel_for(pairs.size(), context,
                      [&](std::size_t at) { meters[pairs[at].first].measure(pairs[at].second, tables); }))
      return false;
    for (LightMeter& meter : meters) meter.end_round();
  }
  for (const MeteredLight& light : lights) kept.keep(light.source, light.bands, light.flux_mm2);
  return true;
}

}  // namespace contrejour::inline internal

namespace contrejour {

LightSource measured_source(const LensState& lens, const Frame& frame, const LightSource& light) {
  const Vec2 uv = frame.uv_from_sensor(chief_ray_image_point(lens, light, lens.design_wavelength_nm));
  const double outside = std::max(std::abs(uv.x - 0.5), std::abs(uv.y - 0.5)) / 0.5;
  if (!(outside > 1.0)) return light;
  const Vec2 edge = Vec2{0.5, 0.5} + (uv - Vec2{0.5, 0.5}) * (1.0 / outside);
  const Vec2 sensor_mm = frame.sensor_from_uv(edge);
  return {direction_for_image_point(lens, sensor_mm, lens.design_wavelength_nm, light.distance_mm), light.distance_mm};
}

}  // namespace contrejour

namespace contrejour::inline internal {

Rgb direct_light(std::span<const SpectralBand> bands, std::span<const double> flux_mm2,
                 const std::function<double(std::size_t band)>& flux_on_axis_mm2) {
  const auto sum = [&](const auto& flux_of) {
    Rgb whole{};
    for (std::size_t k = 0; k < bands.size(); ++k) {
      const double flux = flux_of(k);
      for (std::size_t c = 0; c < whole.size(); ++c) whole[c] += bands[k].weight[c] * flux;
    }
    return whole;
  };
  const Rgb whole = sum([&](std::size_t k) { return flux_mm2[k]; });
  return whole == Rgb{} ? sum(flux_on_axis_mm2) : whole;
}

}  // namespace contrejour::inline internal
