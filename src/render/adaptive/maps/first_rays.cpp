#include "render/adaptive/maps/first_rays.h"

#include <algorithm>
#include <cmath>

namespace contrejour::adaptive {
namespace {

constexpr std::size_t kFirstSamples = 3;  // which tell the tolerance, and the fourth
constexpr std::size_t kManyPasses = 6;    // fewer are all traced
constexpr double kForetoldShare = 0.5;    // of the tolerance: that of the fits comes on top
constexpr double kMostLight = 0.004;      // of a transmission, whatever the tolerance: what many ghosts lack adds up

// What the first `count` samples tell of a pass's transmissions.
std::vector<float> told_transmission(const FirstRays& rays, const WavelengthSamples& samples, std::size_t count,
                                     std::size_t pass) {
  const std::vector<double> factors = samples.factors(count, pass);
  std::vector<float> told(rays.sheets[samples[0]].count(), 0.0F);
  for (std::size_t k = 0; k < count; ++k) {
    const auto factor = static_cast<float>(factors[k]);
    const std::vector<float>& transmission = rays.sheets[samples[k]].transmission;
    for (std::size_t node = 0; node < told.size(); ++node) told[node] += factor * transmission[node];
  }
  return told;
}

void tell_transmissions(FirstRays& rays, const WavelengthSamples& samples, std::size_t count) {
  for (std::size_t pass = 0; pass < rays.sheets.size(); ++pass) {
    const RaySheet& sheet = rays.sheets[pass];
    rays.transmission[pass] = sheet.nodes > 0 ? sheet.transmission : told_transmission(rays, samples, count, pass);
  }
}

// Of any channel at any node whose middle ray arrives, all passes together.
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

// Whether the first `count` samples foretell the next.
bool foretells(const FirstRays& rays, const WavelengthSamples& samples, std::size_t count, const Tolerance& tolerance,
               double pixel_pitch_mm) {
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
      if (!(std::abs(told - is[node]) <= kForetoldShare * allowed)) return false;
    }
    return true;
  };
  const float most = *std::max_element(next.transmission.begin(), next.transmission.end());
  const double off_mm = tolerance.position_px * pixel_pitch_mm;
  const double off_light = std::min(tolerance.weight, kMostLight) * most;
  using Values = const std::vector<float>&;
  if (!holds([](const RaySheet& s) -> Values { return s.sensor_x_mm; }, off_mm) ||
      !holds([](const RaySheet& s) -> Values { return s.sensor_y_mm; }, off_mm) ||
      !holds([](const RaySheet& s) -> Values { return s.transmission; }, off_light))
    return false;
  for (std::size_t c = 0; c < next.stop.size(); ++c) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      if (!holds([&](const RaySheet& s) -> Values { return s.stop[c][axis]; }, tolerance.stop)) return false;
    }
  }
  return true;
}

}  // namespace

FirstRays first_rays(GhostTracers& tracers, const WavelengthSamples& samples, const Rectangle& box, int nodes,
                     const Frame& frame, const ErrorBudget& budget) {
  const std::span<const PlannedPass> passes = tracers.passes();
  FirstRays rays;
  rays.sheets.resize(passes.size());
  rays.transmission.resize(passes.size());
  // Of anything that will do, nothing is fitted.
  const auto precision = std::isfinite(budget.squared_error) ? PacketPrecision::Double : PacketPrecision::Float;
  const auto trace = [&](std::size_t pass) { rays.sheets[pass] = tracers.at(pass).trace(box, nodes, precision); };
  const auto find_tolerance = [&](const RaySheet& middle) {
    rays.tolerance = tolerance_for(middle, largest_weight(rays, middle, passes), tracers.light().source.shared_flux(),
                                   frame, budget);
  };
  for (std::size_t k = 0; passes.size() >= kManyPasses && k < samples.size(); ++k) {
    trace(samples[k]);
    if (k + 1 == kFirstSamples) {
      tell_transmissions(rays, samples, kFirstSamples);
      find_tolerance(rays.sheets[samples[k]]);
    }
    if (k < kFirstSamples || !foretells(rays, samples, k, rays.tolerance, frame.pixel_pitch_mm)) continue;
    rays.samples = k + 1;
    tell_transmissions(rays, samples, rays.samples);
    return rays;
  }
  for (std::size_t pass = 0; pass < passes.size(); ++pass) {
    if (rays.sheets[pass].nodes == 0) trace(pass);
  }
  tell_transmissions(rays, samples, 0);
  find_tolerance(rays.sheets[passes.size() / 2]);
  return rays;
}

std::array<double, 3> light_of(const FirstRays& rays, std::span<const PlannedPass> passes, std::size_t pass) {
  std::array<double, 3> light{};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto gain = static_cast<float>(passes[pass].gain[c]);
    for (const float t : rays.transmission[pass]) light[c] += std::isfinite(t) ? gain * t : 0.0F;
  }
  return light;
}

}  // namespace contrejour::adaptive
