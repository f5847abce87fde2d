// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/parameter_layout.h"

#include <cmath>

namespace contrejour::inline internal {
namespace {

constexpr double kNone = 1e300;
constexpr double kMinSize = 1e-5;   // of half axes and widths, as tangents: far below a pixel
constexpr double kLowestSlope = 0.2, kHighestSlope = 12.0;
constexpr double kLowestRoundness = 0.2, kHighestRoundness = 0.9;
constexpr std::array<double, kGhostCurves> kLower{-kNone, kMinSize, -kNone,   kMinSize,     kLowestRoundness,
                                                  -kNone, kMinSize, kMinSize, kLowestSlope, kLowestSlope,
                                                  -kNone, kMinSize, 0.0,      0.0,          0.0,
                                                  0.0,    0.0,      0.0};
constexpr std::array<double, kGhostCurves> kUpper{kNone, kNone, kNone, kNone,         kHighestRoundness,
                                                  kNone, kNone, kNone, kHighestSlope, kHighestSlope,
                                                  kNone, kNone, kNone, kNone,         kNone,
                                                  kNone, kNone, kNone};

}  // namespace

ParameterLayout::ParameterLayout(const MeasuredFlare& flare) : s_max_(flare.s_max) {
  for (const MeasuredGhost& ghost : flare.ghosts) {
    for (const AngleCurve* curve : curves_of(ghost)) {
      places_.push_back({size_, curve->coefficients.size(), curve->parity});
      size_ += static_cast<Eigen::Index>(curve->coefficients.size());
    }
  }
}

Eigen::VectorXd ParameterLayout::pack(const MeasuredFlare& flare) const {
  Eigen::VectorXd unknowns(size_);
  Eigen::Index at = 0;
  for (const MeasuredGhost& ghost : flare.ghosts) {
    for (const AngleCurve* curve : curves_of(ghost)) {
      for (std::size_t k = 0; k < curve->coefficients.size(); ++k) {
        unknowns[at++] = curve->coefficients[k] * std::pow(s_max_, power_of(curve->parity, k));
      }
    }
  }
  return unknowns;
}

MeasuredFlare ParameterLayout::unpack(const MeasuredFlare& flare, const Eigen::VectorXd& unknowns) const {
  MeasuredFlare result = flare;
  Eigen::Index at = 0;
  for (MeasuredGhost& ghost : result.ghosts) {
    for (AngleCurve* curve : curves_of(ghost)) {
      for (std::size_t k = 0; k < curve->coefficients.size(); ++k) {
        curve->coefficients[k] = unknowns[at++] * std::pow(s_max_, -power_of(curve->parity, k));
      }
    }
  }
  return result;
}

Eigen::VectorXd ParameterLayout::bounds(const std::array<double, kGhostCurves>& of_curves, double otherwise) const {
  Eigen::VectorXd all = Eigen::VectorXd::Constant(size_, otherwise);
  for (std::size_t k = 0; k < places_.size(); ++k) {
    if (places_[k].count > 0) all[places_[k].first] = of_curves[k % kGhostCurves];
  }
  return all;
}

Eigen::VectorXd ParameterLayout::lower() const { return bounds(kLower, -kNone); }
Eigen::VectorXd ParameterLayout::upper() const { return bounds(kUpper, kNone); }

ParameterLayout::CurveTerms ParameterLayout::curve_terms(std::size_t ghost, std::size_t curve, double s) const {
  const Place& at = place(ghost, curve);
  CurveTerms terms{at.first, std::vector<double>(at.count)};
  for (std::size_t k = 0; k < at.count; ++k) terms.terms[k] = std::pow(s / s_max_, power_of(at.parity, k));
  return terms;
}

}  // namespace contrejour::inline internal
