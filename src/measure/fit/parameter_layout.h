// SPDX-License-Identifier: Apache-2.0
// A flare's coefficients as one vector of unknowns, and how a ghost's parameters at one angle depend on them.
// Thread-safety: plain values, pure functions.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "contrejour/expert/measured_flare.h"
#include "measure/model/flare_curves.h"

namespace contrejour::inline internal {

// The unknowns of a flare: the coefficients of all curves of all ghosts, in the order of curves_of(), each multiplied
// by s_max to its power, so that they are of the size of the parameter itself.
class ParameterLayout {
 public:
  explicit ParameterLayout(const MeasuredFlare& flare);

  [[nodiscard]] Eigen::Index size() const { return size_; }
  [[nodiscard]] Eigen::VectorXd pack(const MeasuredFlare& flare) const;
  // The flare with these coefficients.
  [[nodiscard]] MeasuredFlare unpack(const MeasuredFlare& flare, const Eigen::VectorXd& unknowns) const;

  // Bounds of the constant coefficients: sizes, widths and levels are above 0, slopes and roundness where the shade and
  // the outline are well defined. Other unknowns have none.
  [[nodiscard]] Eigen::VectorXd lower() const;
  [[nodiscard]] Eigen::VectorXd upper() const;

  // The derivatives of a curve's value at s with respect to its unknowns: the first is at index `first`.
  struct CurveTerms {
    Eigen::Index first = 0;
    std::vector<double> terms;
  };
  [[nodiscard]] CurveTerms curve_terms(std::size_t ghost, std::size_t curve, double s) const;

 private:
  struct Place {
    Eigen::Index first = 0;
    std::size_t count = 0;
    Parity parity = Parity::Even;
  };
  [[nodiscard]] Eigen::VectorXd bounds(const std::array<double, kGhostCurves>& of_curves, double otherwise) const;
  [[nodiscard]] const Place& place(std::size_t ghost, std::size_t curve) const {
    return places_[ghost * kGhostCurves + curve];
  }

  std::vector<Place> places_;
  double s_max_ = 1.0;
  Eigen::Index size_ = 0;
};

}  // namespace contrejour::inline internal
