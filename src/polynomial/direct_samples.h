// SPDX-License-Identifier: Apache-2.0
// The rays that the direct image's polynomials are fitted to, and those left out to test them.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/direct_polynomials.h"
#include "polynomial/direct_rays.h"
#include "polynomial/least_squares.h"

namespace contrejour::inline internal::polynomial {

inline constexpr int kDirectWavelengths = 13;  // Chebyshev-Lobatto points

struct SensorAndStop {
  Vec2 sensor_mm;  // along x
  Vec2 stop;  // widest radii
};

// Rays through the same points at all wavelengths; those that fail at any of them are left out.
struct DirectSamples {
  std::vector<SensorAndStop> points;
  std::vector<double> clearance;  // by point: the largest over the wavelengths of the relative height and of |stop|
  std::array<std::vector<CameraRay>, kDirectWavelengths> rays;  // by wavelength, then by point

  [[nodiscard]] const std::vector<CameraRay>& middle() const { return rays[kDirectWavelengths / 2]; }
};

// frame: front, sensor and range of wavelengths. Empty if cancelled.
[[nodiscard]] DirectSamples direct_samples(const LensState& lens, const DirectPolynomials& frame,
                                           const Context& context);

// Least squares through rays up to `farthest` relative heights, of which those beyond 1 count less and less.
class DirectSystem {
 public:
  DirectSystem(const DirectSamples& samples, const DirectPolynomials& frame, double farthest);

  [[nodiscard]] bool has_enough_rays(int degree) const;
  // Vectors at every third wavelength, all by one factorisation; members: which of a ray's vectors, and by how much
  // their values may change by leaving terms out.
  struct Member {
    Vec2 CameraRay::* of = nullptr;
    double negligible = 0.0;
  };
  [[nodiscard]] std::vector<ChebyshevVector> vectors(int degree, std::span<const Member> members) const;
  // step: of the wavelengths.
  template <class Value>
  [[nodiscard]] ChebyshevSum scalar(int degree, int step, const Value& value, double negligible) const;

 private:
  [[nodiscard]] Rows matrix(int degree, bool of_vectors) const;
  [[nodiscard]] ChebyshevSum solved(int degree, const std::vector<std::vector<double>>& rights,
                                    double negligible) const;

  const DirectSamples& samples_;
  const DirectPolynomials& frame_;
  std::vector<std::size_t> used_;
  std::vector<double> weight_;
};

template <class Value>
ChebyshevSum DirectSystem::scalar(int degree, int step, const Value& value, double negligible) const {
  std::vector<std::vector<double>> rights;
  for (int l = 0; l < kDirectWavelengths; l += step) {
    std::vector<double>& right = rights.emplace_back();
    for (std::size_t k = 0; k < used_.size(); ++k)
      right.push_back(weight_[k] * value(samples_.rays[static_cast<std::size_t>(l)][used_[k]]));
  }
  return solved(degree, rights, negligible);
}

}  // namespace contrejour::inline internal::polynomial
