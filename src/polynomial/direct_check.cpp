// SPDX-License-Identifier: Apache-2.0
#include "polynomial/direct_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/split_mix.h"
#include "polynomial/direct_evaluate.h"

namespace contrejour::inline internal::polynomial {
namespace {

constexpr int kRaysAtWavelength = 500;
constexpr std::array kLeftOutWavelengths{-0.86, -0.11, 0.57};  // coordinates, none of which is a node of the fit
constexpr double kClearlyBy = 0.01;  // radii by which a ray passes a rim inside or outside

}  // namespace

DirectCheck::DirectCheck(const LensState& lens, const DirectPolynomials& frame) : frame_(frame) {
  std::uint64_t drawn = 11;
  const auto unit = [&] { return unit_interval(split_mix(drawn += kSplitMixIncrement)); };
  for (const double coordinate : kLeftOutWavelengths) {
    const double lambda_nm = direct_wavelength_nm(frame, coordinate);
    const CameraRays rays(lens, lambda_nm, frame.front_z_mm);
    double largest = 0.0;
    for (int k = 0; k < kRaysAtWavelength; ++k) {
      // Points spread evenly over the circle of sensor points and the stop.
      const Vec2 sensor_mm{frame.max_height_mm * std::sqrt(unit()), 0.0};
      const double radius = std::sqrt(unit()), angle = 2.0 * std::numbers::pi * unit();
      const Vec2 stop{radius * std::cos(angle), radius * std::sin(angle)};
      const auto chief = rays.aimed(sensor_mm, {}, rays.straight(sensor_mm, {}));
      const auto inner = chief ? rays.aimed(sensor_mm, stop, *chief) : std::nullopt;
      const auto ray = inner ? rays.trace_from(sensor_mm, *inner) : std::nullopt;
      if (!ray) continue;
      all_.push_back({paths_.size(), sensor_mm, stop, *ray});
      if (ray->largest_height > 1.0) continue;
      open_.push_back(all_.back());
      largest = std::max(largest, ray->transmittance);
    }
    lambda_nm_.push_back(lambda_nm);
    largest_transmittance_.push_back(largest);
    paths_.push_back(direct_path(lens, lambda_nm));
  }
}

DirectCheck::Landing DirectCheck::landing(const DirectPolynomials& fitted) const {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  Landing out;
  for (const Sample& sample : open_) {
    out.sensor_px.push_back(kNever), out.stop.push_back(kNever);
    const auto ray = direct_ray(fitted, sample.sensor_mm, sample.stop, lambda_nm_[sample.wavelength]);
    if (!ray) continue;
    const TracedRay traced = trace(paths_[sample.wavelength], {ray->origin_mm, -ray->direction});
    if (traced.status != RayStatus::Ok) continue;
    out.sensor_px.back() = length(traced.sensor_mm - sample.sensor_mm) / frame_.pixel_mm;
    out.stop.back() = length(traced.stop[0] - sample.stop);
  }
  std::ranges::sort(out.sensor_px);
  std::ranges::sort(out.stop);
  return out;
}

std::vector<double> DirectCheck::rim_errors(const ChebyshevSum& squared, int step) const {
  std::vector<double> errors;
  for (const Sample& sample : open_) {
    const double exact = sample.ray.rim_squared[static_cast<std::size_t>(step)];
    const double found = DirectPoint(frame_, sample.sensor_mm, sample.stop, lambda_nm_[sample.wavelength]).at(squared);
    // A radius, whose square has twice the relative error.
    errors.push_back(0.5 * std::abs(found - exact) / std::max(exact, 0.5));
  }
  std::ranges::sort(errors);
  return errors;
}

std::vector<double> DirectCheck::transmittance_errors(const ChebyshevSum& sum) const {
  std::vector<double> errors;
  for (const Sample& sample : open_) {
    const double found = DirectPoint(frame_, sample.sensor_mm, sample.stop, lambda_nm_[sample.wavelength]).at(sum);
    errors.push_back(std::abs(found - sample.ray.transmittance) /
                     std::max(largest_transmittance_[sample.wavelength], 1e-30));
  }
  std::ranges::sort(errors);
  return errors;
}

void DirectCheck::count_wrongly_blocked(const DirectPolynomials& fitted, DirectAccuracy& accuracy) const {
  int let_through = 0, blocked = 0;
  for (const Sample& sample : all_) {
    const auto ray = direct_ray(fitted, sample.sensor_mm, sample.stop, lambda_nm_[sample.wavelength]);
    const bool passes = ray && ray->relative_height <= 1.0;
    if (passes && sample.ray.largest_height > 1.0 + kClearlyBy) ++let_through;
    if (!passes && sample.ray.largest_height < 1.0 - kClearlyBy) ++blocked;
  }
  const double count = std::max<double>(1.0, static_cast<double>(all_.size()));
  accuracy.let_through = let_through / count;
  accuracy.blocked = blocked / count;
}

}  // namespace contrejour::inline internal::polynomial
