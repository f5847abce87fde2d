// SPDX-License-Identifier: Apache-2.0
// The normal equations of a station's pixels for the values of the curves of its ghosts. Nearly all time of a fit is
// spent here and in distances, so that the products of a pixel's derivatives are summed by SIMD packets.
// Thread-safety: none; one for each station. The sums depend on the instruction set in their last bits.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "measure/fit/ghost_pixels.h"

namespace contrejour::inline internal {

// How a pixel's values depend on one of the ghosts there.
struct PixelTerm {
  std::size_t ghost = 0;  // of the station's
  std::size_t shape = 0;  // how many of by_shape count: kShapeCurves, kPlaceCurves or none
  std::array<std::array<double, kShapeCurves>, 3> by_shape;  // derivatives of each channel's value by curves
  double border = 0, inside = 0;  // derivatives of a channel's value by its own levels
};

// A pixel's channels: weights, and weights times the model's difference from the picture.
struct PixelResidual {
  std::array<double, 3> weight{}, weighted{};
};

// Sums of products of the derivatives of two ghosts, the first of which comes first or is the same. Columns stand for
// curves of the second one.
struct GhostProducts {
  std::array<double, kShapeCurves * kShapeCurves> shape{};  // of one ghost with itself: down to the diagonal at least
  std::array<double, 6 * kShapeCurves> shape_by_level{};  // levels of the second one: border, then inside, by channel
  std::array<double, 6 * kShapeCurves> level_by_shape{};  // a column for each level of the first one
  std::array<double, 3 * 4> levels{};  // by channel: border and border, border and inside, inside and border, inside
};

// The same for pixels that depend on the places of both ghosts only. They are many, and stay in the cache by
// themselves.
using PlaceProducts = std::array<double, kPlaceCurves * kPlaceCurves>;

class PixelEquations {
 public:
  explicit PixelEquations(std::size_t ghosts);

  // terms: in ascending order of their ghosts.
  void add(std::span<const PixelTerm> terms, const PixelResidual& residual);

  // In the order of curves_of(), ghost after ghost.
  [[nodiscard]] const Eigen::VectorXd& gradient() const { return gradient_; }
  // Blocks of two ghosts above the diagonal only; those on the diagonal whole.
  [[nodiscard]] Eigen::MatrixXd hessian() const;

 private:
  std::size_t ghosts_;
  Eigen::VectorXd gradient_;
  std::vector<GhostProducts> products_;  // a triangle, row by row
  std::vector<PlaceProducts> places_;
};

}  // namespace contrejour::inline internal
