// SPDX-License-Identifier: Apache-2.0
// Least-squares polynomials for smooth functions of a place that are known at scattered places. The basis consists of
// products of Chebyshev polynomials over the places' bounding box, so that the normal equations stay well conditioned.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "contrejour/expert/vec.h"

namespace contrejour::inline internal {

class SmoothFit {
 public:
  static constexpr int kHighestDegree = 8;
  static constexpr std::size_t kPlacesPerTerm = 3;  // the fewest with which a fit averages the measurements

  // values[f * places.size() + i]: the value of function f at places[i]. degree: the total degree in both coordinates.
  SmoothFit(std::span<const Vec2> places, std::span<const double> values, int degree);

  // Evaluates all functions at a place.
  void evaluate(Vec2 place, double* values) const;
  [[nodiscard]] double operator()(Vec2 place, std::size_t function = 0) const;

  [[nodiscard]] std::size_t functions() const { return functions_; }
  [[nodiscard]] static std::size_t terms(int degree) {
    return static_cast<std::size_t>(degree + 1) * static_cast<std::size_t>(degree + 2) / 2;
  }

 private:
  void basis_at(Vec2 place, double* basis) const;

  int degree_;
  std::size_t functions_ = 0;
  Vec2 middle_, half_;
  std::vector<double> weights_;  // [function * terms + term]
};

}  // namespace contrejour::inline internal
