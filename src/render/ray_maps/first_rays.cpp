// SPDX-License-Identifier: Apache-2.0
#include "render/ray_maps/first_rays.h"

#include <algorithm>
#include <cmath>

#include "render/ray_maps/wavelength_flux.h"

namespace contrejour::inline internal::ray_maps {
namespace {

constexpr std::size_t kFirstSamples = 3;  // wavelengths that give the tolerance and predict the fourth
constexpr std::size_t kMaxTraced = 9;    // if these do not predict the last of them, all passes are traced
constexpr std::size_t kManyPasses = 6;    // fewer passes are all traced

// The transmittances of a pass, up to a factor, interpolated from those of the first `count` samples.
std::vector<float> pattern_of(const FirstRays& rays, const WavelengthSamples& samples, std::size_t count,
                              std::size_t pass) {
  const std::vector<double> factors = light_factors(samples, count, pass, rays.is_linear);
  std::vector<float> pattern(rays.ray_sets[samples[0]].count(), 0.0F);
  for (std::size_t k = 0; k < count; ++k) {
    if (factors[k] == 0.0) continue;
    const auto factor = static_cast<float>(factors[k]);
    const std::vector<float>& transmission = rays.ray_sets[samples[k]].transmission;
    for (std::size_t node = 0; node < pattern.size(); ++node) pattern[node] += factor * transmission[node];
  }
  return pattern;
}

// Sets the transmittances of passes without rays: the samples' pattern times `light`.
void interpolate_transmissions(FirstRays& rays, const WavelengthSamples& samples, std::size_t count) {
  for (std::size_t pass = 0; pass < rays.ray_sets.size(); ++pass) {
    const LobattoRays& ray_set = rays.ray_sets[pass];
    if (ray_set.nodes > 0) {
      rays.transmission[pass] = ray_set.transmission;
      continue;
    }
    rays.transmission[pass] = pattern_of(rays, samples, count, pass);
    for (float& t : rays.transmission[pass]) t *= static_cast<float>(rays.light[pass]);
  }
}

// The largest weight of any channel at any node whose ray of the middle pass arrives, summed over all passes.
double largest_weight(const FirstRays& rays, const LobattoRays& middle, std::span<const PlannedPass> passes) {
  double largest = 0.0;
  for (std::size_t node = 0; node < middle.count(); ++node) {
    if (!middle.counts(node)) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0.0;
      for (std::size_t k = 0; k < passes.size(); ++k)
        sum += static_cast<float>(passes[k].gain[c]) * rays.transmission[k][node];
      largest = std::max(largest, std::abs(sum));
    }
  }
  return largest;
}

float largest_transmission(const LobattoRays& ray_set) {
  float largest = 0.0F;
  for (std::size_t node = 0; node < ray_set.count(); ++node)
    if (!ray_set.arrives(node) || ray_set.counts(node)) largest = std::max(largest, ray_set.transmission[node]);
  return largest;
}

double sum_of(std::span<const float> values, const std::vector<bool>& counts) {
  double sum = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) sum += counts[k] ? values[k] : 0.0F;
  return sum;
}

// Returns whether the first `count` samples predict how the next sample's transmittance varies over the nodes that
// count: by polynomials, or else by straight lines.
bool predicts_pattern(FirstRays& rays, const WavelengthSamples& samples, std::size_t count,
                      const std::vector<bool>& counts, double allowed) {
  const std::vector<float>& is = rays.ray_sets[samples[count]].transmission;
  const float largest = largest_transmission(rays.ray_sets[samples[count]]);
  const double sum = sum_of(is, counts);
  for (const bool is_linear : {false, true}) {
    rays.is_linear = is_linear;
    const std::vector<float> pattern = pattern_of(rays, samples, count, samples[count]);
    const double predicted = sum_of(pattern, counts);
    const double times = predicted > 0.0 ? sum / predicted : 0.0;
    bool holds = true;
    for (std::size_t node = 0; node < is.size(); ++node)
      holds = holds && (!counts[node] || std::abs(times * pattern[node] - is[node]) <= allowed * largest);
    if (holds) return true;
  }
  return false;
}

// Returns whether the first `count` samples predict the next one.
bool predicts_next(FirstRays& rays, const WavelengthSamples& samples, std::size_t count, const Tolerance& tolerance,
                   const FirstRaysOptions& options) {
  const LobattoRays& next = rays.ray_sets[samples[count]];
  const std::vector<double> factors = samples.factors(count, samples[count]);
  std::vector<bool> arrives(next.count());
  for (std::size_t node = 0; node < next.count(); ++node) {
    arrives[node] = next.counts(node);
    for (std::size_t k = 0; k < count; ++k) arrives[node] = arrives[node] && rays.ray_sets[samples[k]].counts(node);
  }
  const auto holds = [&](auto values, double allowed) {
    const std::vector<float>& is = values(next);
    for (std::size_t node = 0; node < next.count(); ++node) {
      if (!arrives[node]) continue;
      double predicted = 0.0;
      for (std::size_t k = 0; k < count; ++k) predicted += factors[k] * values(rays.ray_sets[samples[k]])[node];
      if (!(std::abs(predicted - is[node]) <= options.predicted_fraction * allowed)) return false;
    }
    return true;
  };
  const double off_mm = tolerance.position_px * options.pixel_pitch_mm;
  using Values = const std::vector<float>&;
  if (!holds([](const LobattoRays& s) -> Values { return s.sensor_x_mm; }, off_mm) ||
      !holds([](const LobattoRays& s) -> Values { return s.sensor_y_mm; }, off_mm))
    return false;
  for (std::size_t c = 0; c < next.stop.size(); ++c) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (!holds([&](const LobattoRays& s) -> Values { return s.stop[c][axis]; }, tolerance.stop)) return false;
    }
  }
  return predicts_pattern(rays, samples, count, arrives,
                          std::min(options.predicted_fraction * tolerance.weight, options.max_tint));
}

// Finds the factors of the patterns that the first `count` samples predict. Where polynomials are off by more than
// kMaxRatio, straight lines replace them. Returns false if no node counts.
bool find_light(FirstRays& rays, GhostTracers& tracers, const WavelengthSamples& samples, std::size_t count) {
  constexpr double kMaxRatio = 1.5;
  WavelengthFlux passes(tracers, rays.ray_sets, samples, count);
  if (!passes.any()) return false;
  const std::vector<double> light = passes.of_all();
  const auto find = [&] {
    bool close = true;
    for (std::size_t pass = 0; pass < light.size(); ++pass) {
      const double predicted = passes.sum(pattern_of(rays, samples, count, pass));
      rays.light[pass] = rays.ray_sets[pass].nodes > 0 ? 1.0 : predicted > 0.0 ? light[pass] / predicted : 0.0;
      close = close && rays.light[pass] <= kMaxRatio && rays.light[pass] >= 1.0 / kMaxRatio;
    }
    return close;
  };
  if (find() || rays.is_linear) return true;
  rays.is_linear = true;
  find();
  return true;
}

}  // namespace

FirstRays first_rays(GhostTracers& tracers, const WavelengthSamples& samples, const Rectangle& box,
                     const ToleranceOf& tolerance_of, const FirstRaysOptions& options) {
  const std::span<const PlannedPass> passes = tracers.passes();
  FirstRays rays;
  rays.ray_sets.resize(passes.size());
  rays.transmission.resize(passes.size());
  rays.light.assign(passes.size(), 1.0);
  const auto trace = [&](std::size_t pass) {
    rays.ray_sets[pass] = tracers.at(pass).trace(box, options.nodes, options.precision);
  };
  const auto find_tolerance = [&](const LobattoRays& middle) {
    rays.largest_weight = largest_weight(rays, middle, passes);
    rays.tolerance = tolerance_of(middle, rays.largest_weight, tracers.light().source.shared_flux());
  };
  const std::size_t max_traced = passes.size() >= kManyPasses ? std::min(samples.size(), kMaxTraced) : 0;
  for (std::size_t k = 0; k < max_traced; ++k) {
    trace(samples[k]);
    if (k + 1 == kFirstSamples) {
      interpolate_transmissions(rays, samples, kFirstSamples);
      find_tolerance(rays.ray_sets[samples[k]]);
    }
    if (k < kFirstSamples || !predicts_next(rays, samples, k, rays.tolerance, options)) continue;
    if (!find_light(rays, tracers, samples, k + 1)) break;
    rays.samples = k + 1;
    interpolate_transmissions(rays, samples, rays.samples);
    find_tolerance(rays.ray_sets[samples[kFirstSamples - 1]]);
    return rays;
  }
  std::ranges::fill(rays.light, 1.0);
  rays.is_linear = false;
  for (std::size_t pass = 0; pass < passes.size(); ++pass) {
    if (rays.ray_sets[pass].nodes == 0) trace(pass);
  }
  interpolate_transmissions(rays, samples, 0);
  find_tolerance(rays.ray_sets[passes.size() / 2]);
  return rays;
}

std::vector<double> light_factors(const WavelengthSamples& samples, std::size_t count, std::size_t pass,
                                  bool is_linear) {
  return is_linear ? samples.linear_weights(count, pass) : samples.factors(count, pass);
}

Rgb light_of(const FirstRays& rays, std::span<const PlannedPass> passes, std::size_t pass) {
  const auto traced = std::ranges::find_if(rays.ray_sets, [](const LobattoRays& set) { return set.nodes > 0; });
  const std::vector<float>& transmission = rays.transmission[pass];
  double sum = 0.0;
  for (std::size_t node = 0; node < transmission.size(); ++node)
    if ((!traced->arrives(node) || traced->counts(node)) && std::isfinite(transmission[node]))
      sum += transmission[node];
  Rgb light = passes[pass].gain;
  for (double& of_channel : light) of_channel *= sum;
  return light;
}

}  // namespace contrejour::inline internal::ray_maps
