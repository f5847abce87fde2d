// SPDX-License-Identifier: Apache-2.0
// Exact rays that a zone was not fitted to, and the errors of its polynomials there.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "polynomial/zone_rays.h"

namespace contrejour::inline internal::polynomial {

// Coordinates of the wavelength, none of which is a node of a fit.
inline constexpr std::array kTestedWavelengths{-0.86, -0.11, 0.57};
// More rays, at the middle one, must not be let through if they are blocked: edges count little where a fit may turn
// back.
inline constexpr std::size_t kBlockedWavelength = 1;
// Distances from the sensor's middle, in its half diagonals: of light that counts in full, of light that is in the
// frame or next to it, and up to which no light may be placed that lands beyond the first.
inline constexpr double kNearSensor = 1.6, kLandingNear = 1.1, kOnSensor = 1.02;
inline constexpr std::size_t kFirstLeftOut = 100'003;  // in the sequence of points, beyond those of fits

// One of the rays, and one of the wavelengths.
struct LeftOutRay {
  std::size_t wavelength = 0, ray = 0;
};

class LeftOutRays {
 public:
  using VectorAt = std::function<Vec2(const LeftOutRay&)>;
  using ScalarAt = std::function<double(const LeftOutRay&)>;
  // The largest of the relative height and the distances from the stop's centre.
  using ClearanceAt = std::function<double(const LeftOutRay&)>;

  // blocked_starts: more rays at the middle wavelength. sensor_half_mm: half the sensor's size.
  LeftOutRays(const LensPolynomials& lens, const GhostRays& rays, std::vector<RayStart> starts,
              std::vector<RayStart> blocked_starts, Vec2 sensor_half_mm);

  // Errors of all rays that get through, rising; empty if none does. Positions and transmittances are those of rays
  // that land on the sensor or near it, or of all if few do.
  [[nodiscard]] std::vector<double> position_errors_mm(const VectorAt& sensor) const;
  [[nodiscard]] std::vector<double> stop_errors(const VectorAt& stop, std::size_t crossing) const;
  [[nodiscard]] std::vector<double> rim_errors(const ScalarAt& squared, int step) const;
  [[nodiscard]] std::vector<double> transmittance_errors(const ScalarAt& transmittance) const;

  // True if these clearances let a ray through that is blocked or fails, with a margin.
  [[nodiscard]] bool admits_blocked_light(const ClearanceAt& of_rays, const ClearanceAt& of_blocked) const;

  // True if light that lands far from the sensor is placed on it.
  [[nodiscard]] bool brings_light_in(const VectorAt& sensor) const;

  [[nodiscard]] int open_rays() const { return static_cast<int>(open_.size()); }
  [[nodiscard]] const std::vector<RayStart>& starts() const { return starts_; }
  [[nodiscard]] const std::vector<RayStart>& blocked_starts() const { return blocked_starts_; }

 private:
  std::vector<RayStart> starts_, blocked_starts_;
  RayTable blocked_table_;
  std::vector<RayTable> tables_;  // one a wavelength
  std::vector<double> largest_transmittance_;
  double half_diagonal_mm_;
  std::vector<LeftOutRay> open_, landing_;
};

// The value that a fraction of rising values do not exceed; infinite without values.
[[nodiscard]] double quantile(const std::vector<double>& rising, double fraction);

}  // namespace contrejour::inline internal::polynomial
