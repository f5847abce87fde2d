#include "render/interface/direct_light.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "base/tasks.h"
#include "ghosts/direct_meter.h"
#include "render/interface/wavelength_samples.h"

namespace contrejour {
namespace {

constexpr std::size_t kSamples = 7;    // of many bands: six, and one that they foretell
constexpr std::size_t kManyBands = 10;  // fewer are all measured
constexpr double kForetold = 2e-4;     // of the largest flux

WavelengthSamples samples_of(std::span<const SpectralBand> bands) {
  std::vector<double> lambda_nm;
  for (const SpectralBand& band : bands) lambda_nm.push_back(band.lambda_nm);
  return {lambda_nm, bands.size() >= kManyBands ? kSamples : 0};
}

double told(const MeteredLight& light, const WavelengthSamples& samples, std::size_t count, std::size_t band) {
  const std::vector<double> factors = samples.factors(count, band);
  double flux = 0.0;
  for (std::size_t k = 0; k < count; ++k) flux += factors[k] * light.flux_mm2[samples[k]];
  return flux;
}

// Of the samples' fluxes, whether all but the last foretell it.
bool foretell(const MeteredLight& light, const WavelengthSamples& samples) {
  double most = 0.0;
  for (std::size_t k = 0; k < samples.size(); ++k) most = std::max(most, light.flux_mm2[samples[k]]);
  const std::size_t last = samples.size() - 1;
  return std::abs(told(light, samples, last, samples[last]) - light.flux_mm2[samples[last]]) <= kForetold * most;
}

}  // namespace

bool measure_fluxes(const LensState& lens, const TablesByWavelength& tables, std::span<MeteredLight> lights,
                    const Context& context) {
  using Place = std::pair<std::size_t, std::size_t>;  // light, band
  std::vector<DirectMeter> meters;
  std::vector<WavelengthSamples> samples;
  std::vector<Place> first, others;
  for (std::size_t k = 0; k < lights.size(); ++k) {
    const std::size_t bands = lights[k].bands.size();
    meters.emplace_back(lens, lights[k].source);
    samples.push_back(samples_of(lights[k].bands));
    lights[k].flux_mm2.assign(bands, 0.0);
    const bool few = samples[k].size() < kSamples;
    for (std::size_t at = 0; at < (few ? bands : kSamples); ++at) first.emplace_back(k, few ? at : samples[k][at]);
  }
  const auto tables_of = [&](std::size_t k, std::size_t band) -> const ReflectanceTables& {
    return *tables.at(lights[k].bands[band].lambda_nm);
  };
  // The middle wavelength's pupil serves the others: where nothing of it gets through, no more than a sliver of theirs
  // does.
  std::vector<std::optional<Rectangle>> pupil(lights.size());
  if (!parallel_for(lights.size(), context,
                    [&](std::size_t k) { pupil[k] = meters[k].pupil(tables_of(k, lights[k].bands.size() / 2)); }))
    return false;
  const auto measure = [&](const std::vector<Place>& places) {
    return parallel_for(places.size(), context, [&](std::size_t at) {
      const auto [k, band] = places[at];
      lights[k].flux_mm2[band] = pupil[k] ? meters[k].flux_mm2(tables_of(k, band), *pupil[k]) : 0.0;
    });
  };
  if (!measure(first)) return false;
  for (std::size_t k = 0; k < lights.size(); ++k) {
    if (samples[k].size() < kSamples) continue;
    std::vector<bool> done(lights[k].bands.size(), false);
    for (std::size_t at = 0; at < kSamples; ++at) done[samples[k][at]] = true;
    const bool foretold = foretell(lights[k], samples[k]);
    for (std::size_t band = 0; band < done.size(); ++band) {
      if (done[band]) continue;
      if (foretold)
        lights[k].flux_mm2[band] = std::max(0.0, told(lights[k], samples[k], kSamples, band));
      else
        others.emplace_back(k, band);
    }
  }
  return measure(others);
}

LightSource measured_source(const LensState& lens, const Frame& frame, const LightSource& light) {
  const Vec2 uv = frame.uv_from_sensor(landing_of(lens, light, lens.design_wavelength_nm));
  const double outside = std::max(std::abs(uv.x - 0.5), std::abs(uv.y - 0.5)) / 0.5;
  if (!(outside > 1.0)) return light;
  const Vec2 edge = Vec2{0.5, 0.5} + (uv - Vec2{0.5, 0.5}) * (1.0 / outside);
  const Vec2 sensor_mm = frame.sensor_from_uv(edge);
  return {direction_to_land_at(lens, sensor_mm, lens.design_wavelength_nm, light.distance_mm), light.distance_mm};
}

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

}  // namespace contrejour
