// SPDX-License-Identifier: Apache-2.0
// Polynomials of one light and wavelength at many points of the pupil, in packets (Highway): powers of v and w by
// Horner's rule, in float. Accuracy: a few roundings of float, relative to the sum of the coefficients' sizes.
// Cost: docs/physics/polynomial.md, "Cost of a point".
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "polynomial/chebyshev_basis.h"

namespace contrejour::inline internal::polynomial {

// The position of v^j w^k among the coefficients: by rising j + k, so that those up to a degree come first.
[[nodiscard]] constexpr int power_index(int j, int k) { return (j + k) * (j + k + 1) / 2 + k; }

inline constexpr int kMaxPowerDegree = 13;
struct PowerSum {
  int degree = 0;  // of v and w together, at most kMaxPowerDegree
  std::array<float, static_cast<std::size_t>(pair_count(kMaxPowerDegree))> coefficients{};
};

// From a start, relative to an origin, to the pupil point p, and v = h p_x, w = 2 p.p - 1; without symmetry v = p_x and
// w = p_y.
struct PupilMap {
  float x = 0.0F, y = 0.0F;  // the pupil point of the origin
  float per_mm = 1.0F;
  float h = 0.0F;
  bool symmetric = true;
  float y_per_mm = 1.0F;  // without symmetry: along y
  // With symmetry: for the sensor's vector and the transmittance w is 1 - 2 sqrt(1 - p.p per_end); 0: it is as for all.
  float per_end = 0.0F;
};

// h along_field + p along_pupil, written to x and y. Without symmetry along_field is x and along_pupil y.
struct VectorOutput {
  const PowerSum* along_field = nullptr;
  const PowerSum* along_pupil = nullptr;
  float* x = nullptr;
  float* y = nullptr;
};
struct ScalarOutput {
  const PowerSum* sum = nullptr;
  float* values = nullptr;  // null: not wanted
};

struct PointOutputs {
  std::span<const VectorOutput> vectors = {};
  std::span<const ScalarOutput> rims = {};  // squared relative heights
  // The largest of the rims' and of distances from the stop's centre times stop_scale; null: not wanted. The crossings
  // of the stop are the last `crossings` vectors.
  float* relative_height = nullptr;
  std::size_t crossings = 0;
  float stop_scale = 0.0F;
  ScalarOutput transmittance = {};  // 0 to largest_transmittance
  float largest_transmittance = 0.0F;
};

void evaluate_points(const PupilMap& map, const float* x_mm, const float* y_mm, std::size_t count,
                     const PointOutputs& out);

}  // namespace contrejour::inline internal::polynomial
