// SPDX-License-Identifier: Apache-2.0
// The normal equations that SIMD packets sum, against plain sums over all curves and channels.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "measure/fit/pixel_equations.h"
#include "measure/model/flare_curves.h"

using namespace contrejour;

namespace {

constexpr std::size_t kGhostsOfTest = 4;

// All kinds of pixels: near a border, inside a profile, flat.
PixelTerm random_term(std::size_t ghost, std::mt19937& random) {
  std::uniform_real_distribution<double> number(-1.0, 1.0);
  PixelTerm term{};
  term.ghost = ghost;
  const auto kind = random() % 3;
  term.shape = kind == 0 ? kShapeCurves : kind == 1 ? kPlaceCurves : 0;
  for (auto& channel : term.by_shape)
    for (double& derivative : channel) derivative = number(random);  // those that do not count, too
  if (kind == 0) term.border = number(random);
  if (kind != 1) term.inside = number(random);
  return term;
}

// The derivatives of a channel's value with respect to all curves of all ghosts.
Eigen::VectorXd gradient_of(const std::vector<PixelTerm>& terms, std::size_t channel) {
  Eigen::VectorXd all = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(kGhostsOfTest * kGhostCurves));
  for (const PixelTerm& term : terms) {
    const auto at = static_cast<Eigen::Index>(kGhostCurves * term.ghost);
    for (std::size_t k = 0; k < term.shape; ++k) all[at + static_cast<Eigen::Index>(k)] = term.by_shape[channel][k];
    all[at + static_cast<Eigen::Index>(kShapeCurves + channel)] = term.border;
    all[at + static_cast<Eigen::Index>(kShapeCurves + 3 + channel)] = term.inside;
  }
  return all;
}

}  // namespace

TEST_CASE("pixel equations: sums of products of all curves are those of the definition") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> number(0.0, 1.0);
  PixelEquations equations(kGhostsOfTest);
  const auto size = static_cast<Eigen::Index>(kGhostsOfTest * kGhostCurves);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(size);
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(size, size);
  for (int pixel = 0; pixel < 200; ++pixel) {
    std::vector<PixelTerm> terms;
    for (std::size_t ghost = 0; ghost < kGhostsOfTest; ++ghost)
      if (random() % 3 != 0) terms.push_back(random_term(ghost, random));
    PixelResidual residual;
    for (std::size_t c = 0; c < 3; ++c) {
      residual.weight[c] = number(random);
      residual.weighted[c] = residual.weight[c] * (number(random) - 0.5);
      const Eigen::VectorXd by_curve = gradient_of(terms, c);
      gradient += residual.weighted[c] * by_curve;
      hessian += residual.weight[c] * by_curve * by_curve.transpose();
    }
    equations.add(terms, residual);
  }
  CHECK((equations.gradient() - gradient).cwiseAbs().maxCoeff() < 1e-12);
  const Eigen::MatrixXd summed = equations.hessian();
  double off = 0.0;
  for (Eigen::Index row = 0; row < size; ++row) {
    const auto of_ghost = static_cast<Eigen::Index>(kGhostCurves);
    for (Eigen::Index column = row / of_ghost * of_ghost; column < size; ++column)
      off = std::max(off, std::abs(summed(row, column) - hessian(row, column)));
  }
  CHECK(hessian.cwiseAbs().maxCoeff() > 10.0);
  CHECK(off < 1e-12);
}
