// SPDX-License-Identifier: Apache-2.0
// Least-squares polynomials for smooth functions of a point that are known at scattered points. The basis consists of
// products of Chebyshev polynomials over the points' bounding box, so that the normal equations stay well conditioned.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "contrejour/expert/vec.h"

namespace contrejour::inline internal {

class SmoothFit {
 public:
  static constexpr int kHighestDegree = 8;
  static constexpr std::size_t kPointsPerTerm = 3;  // the fewest with which a fit averages the measurements

  // values[f * points.size() + i]: the value of function f at points[i]. degree: the total degree in both coordinates.
  SmoothFit(std::span<const Vec2> points, std::span<const double> values, int degree);

  // Evaluates all functions at a point.
  void evaluate(Vec2 point, double* values) const;
  [[nodiscard]] double operator()(Vec2 point, std::size_t function = 0) const;

  [[nodiscard]] std::size_t functions() const { return functions_; }
  [[nodiscard]] static std::size_t terms(int degree) {
    return static_cast<std::size_t>(degree + 1) * static_cast<std::size_t>(degree + 2) / 2;
  }

 private:
  void basis_at(Vec2 point, double* basis) const;

  int degree_;
  std::size_t functions_ = 0;
  Vec2 middle_, half_;
  std::vector<double> weights_;  // [function * terms + term]
};

}  // namespace contrejour::inline internal
