// SPDX-License-Identifier: Apache-2.0
#include "render/ray_maps/first_rays.h"

#include <algorithm>
#include <cmath>

#include "render/ray_maps/pass_light.h"

namespace contrejour::inline internal::ray_maps {
namespace {

constexpr std::size_t kFirstSamples = 3;  // wavelengths that give the tolerance and predict the fourth
constexpr std::size_t kMostTraced = 9;    // if these do not predict the last of them, all passes are traced
constexpr std::size_t kManyPasses = 6;    // fewer passes are all traced

// The transmittances of a pass, up to a factor, interpolated from those of the first `count` samples.
std::vector<float> pattern_of(const FirstRays& rays, const WavelengthSamples& samples, std::size_t count,
                              std::size_t pass) {
  const std::vector<double> shares = light_factors(samples, count, pass, rays.straight);
  std::vector<float> pattern(rays.sheets[samples[0]].count(), 0.0F);
  for (std::size_t k = 0; k < count; ++k) {
    if (shares[k] == 0.0) continue;
    const auto share = static_cast<float>(shares[k]);
    const std::vector<float>& transmission = rays.sheets[samples[k]].transmission;
    for (std::size_t node = 0; node < pattern.size(); ++node) pattern[node] += share * transmission[node];
  }
  return pattern;
}

// Sets the transmittances of passes without rays: the samples' pattern times `light`.
void tell_transmissions(FirstRays& rays, const WavelengthSamples& samples, std::size_t count) {
  for (std::size_t pass = 0; pass < rays.sheets.size(); ++pass) {
    const RaySheet& sheet = rays.sheets[pass];
    if (sheet.nodes > 0) {
      rays.transmission[pass] = sheet.transmission;
      continue;
    }
    rays.transmission[pass] = pattern_of(rays, samples, count, pass);
    for (float& t : rays.transmission[pass]) t *= static_cast<float>(rays.light[pass]);
  }
}

// The largest weight of any channel at any node whose ray of the middle pass arrives, summed over all passes.
double largest_weight(const FirstRays& rays, const RaySheet& middle, std::span<const PlannedPass> passes) {
  double largest = 0.0;
  for (std::size_t node = 0; node < middle.count(); ++node) {
    if (std::isinf(middle.r_rel[node])) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0.0;
      for (std::size_t k = 0; k < passes.size(); ++k)
        sum += static_cast<float>(passes[k].gain[c]) * rays.transmission[k][node];
      largest = std::max(largest, std::abs(sum));
    }
  }
  return largest;
}

double sum_of(std::span<const float> values, const std::vector<bool>& counts) {
  double sum = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) sum += counts[k] ? values[k] : 0.0F;
  return sum;
}

// Whether the first `count` samples predict how the next sample's transmittance varies over the nodes that count: by
// polynomials, or else by straight lines.
bool foretells_pattern(FirstRays& rays, const WavelengthSamples& samples, std::size_t count,
                       const std::vector<bool>& counts, double allowed) {
  const std::vector<float>& is = rays.sheets[samples[count]].transmission;
  const float most = *std::max_element(is.begin(), is.end());
  const double sum = sum_of(is, counts);
  for (const bool straight : {false, true}) {
    rays.straight = straight;
    const std::vector<float> pattern = pattern_of(rays, samples, count, samples[count]);
    const double told = sum_of(pattern, counts);
    const double times = told > 0.0 ? sum / told : 0.0;
    bool holds = true;
    for (std::size_t node = 0; node < is.size(); ++node)
      holds = holds && (!counts[node] || std::abs(times * pattern[node] - is[node]) <= allowed * most);
    if (holds) return true;
  }
  return false;
}

// Whether the first `count` samples predict the next one.
bool foretells(FirstRays& rays, const WavelengthSamples& samples, std::size_t count, const Tolerance& tolerance,
               const FirstRaysOptions& options) {
  const RaySheet& next = rays.sheets[samples[count]];
  const std::vector<double> factors = samples.factors(count, samples[count]);
  std::vector<bool> arrives(next.count());
  for (std::size_t node = 0; node < next.count(); ++node) {
    arrives[node] = std::isfinite(next.r_rel[node]);
    for (std::size_t k = 0; k < count; ++k)
      arrives[node] = arrives[node] && std::isfinite(rays.sheets[samples[k]].r_rel[node]);
  }
  const auto holds = [&](auto values, double allowed) {
    const std::vector<float>& is = values(next);
    for (std::size_t node = 0; node < next.count(); ++node) {
      if (!arrives[node]) continue;
      double told = 0.0;
      for (std::size_t k = 0; k < count; ++k) told += factors[k] * values(rays.sheets[samples[k]])[node];
      if (!(std::abs(told - is[node]) <= options.predicted_share * allowed)) return false;
    }
    return true;
  };
  const double off_mm = tolerance.position_px * options.pixel_pitch_mm;
  using Values = const std::vector<float>&;
  if (!holds([](const RaySheet& s) -> Values { return s.sensor_x_mm; }, off_mm) ||
      !holds([](const RaySheet& s) -> Values { return s.sensor_y_mm; }, off_mm))
    return false;
  for (std::size_t c = 0; c < next.stop.size(); ++c) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (!holds([&](const RaySheet& s) -> Values { return s.stop[c][axis]; }, tolerance.stop)) return false;
    }
  }
  return foretells_pattern(rays, samples, count, arrives, std::min(tolerance.weight, options.most_tint));
}

// Finds the factors of the patterns that the first `count` samples predict. Where polynomials are off by more than
// kMost, straight lines replace them. Returns false if no node counts.
bool find_light(FirstRays& rays, GhostTracers& tracers, const WavelengthSamples& samples, std::size_t count) {
  constexpr double kMost = 1.5;
  PassLight passes(tracers, rays.sheets, samples, count);
  if (!passes.any()) return false;
  const std::vector<double> light = passes.of_all();
  const auto find = [&] {
    bool close = true;
    for (std::size_t pass = 0; pass < light.size(); ++pass) {
      const double told = passes.sum(pattern_of(rays, samples, count, pass));
      rays.light[pass] = rays.sheets[pass].nodes > 0 ? 1.0 : told > 0.0 ? light[pass] / told : 0.0;
      close = close && rays.light[pass] <= kMost && rays.light[pass] >= 1.0 / kMost;
    }
    return close;
  };
  if (find() || rays.straight) return true;
  rays.straight = true;
  find();
  return true;
}

}  // namespace

FirstRays first_rays(GhostTracers& tracers, const WavelengthSamples& samples, const Rectangle& box,
                     const ToleranceOf& tolerance_of, const FirstRaysOptions& options) {
  const std::span<const PlannedPass> passes = tracers.passes();
  FirstRays rays;
  rays.sheets.resize(passes.size());
  rays.transmission.resize(passes.size());
  rays.light.assign(passes.size(), 1.0);
  const auto trace = [&](std::size_t pass) {
    rays.sheets[pass] = tracers.at(pass).trace(box, options.nodes, options.precision);
  };
  const auto find_tolerance = [&](const RaySheet& middle) {
    rays.tolerance = tolerance_of(middle, largest_weight(rays, middle, passes), tracers.light().source.shared_flux());
  };
  const std::size_t most = passes.size() >= kManyPasses ? std::min(samples.size(), kMostTraced) : 0;
  for (std::size_t k = 0; k < most; ++k) {
    trace(samples[k]);
    if (k + 1 == kFirstSamples) {
      tell_transmissions(rays, samples, kFirstSamples);
      find_tolerance(rays.sheets[samples[k]]);
    }
    if (k < kFirstSamples || !foretells(rays, samples, k, rays.tolerance, options)) continue;
    if (!find_light(rays, tracers, samples, k + 1)) break;
    rays.samples = k + 1;
    tell_transmissions(rays, samples, rays.samples);
    find_tolerance(rays.sheets[samples[kFirstSamples - 1]]);
    return rays;
  }
  std::ranges::fill(rays.light, 1.0);
  rays.straight = false;
  for (std::size_t pass = 0; pass < passes.size(); ++pass) {
    if (rays.sheets[pass].nodes == 0) trace(pass);
  }
  tell_transmissions(rays, samples, 0);
  find_tolerance(rays.sheets[passes.size() / 2]);
  return rays;
}

std::vector<double> light_factors(const WavelengthSamples& samples, std::size_t count, std::size_t pass,
                                  bool straight) {
  return straight ? samples.shares(count, pass) : samples.factors(count, pass);
}

std::array<double, 3> light_of(const FirstRays& rays, std::span<const PlannedPass> passes, std::size_t pass) {
  std::array<double, 3> light{};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto gain = static_cast<float>(passes[pass].gain[c]);
    for (const float t : rays.transmission[pass]) light[c] += std::isfinite(t) ? gain * t : 0.0F;
  }
  return light;
}

}  // namespace contrejour::inline internal::ray_maps
