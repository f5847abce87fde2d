// SPDX-License-Identifier: Apache-2.0
// The linear problem of reflectances: ranks by hand, warnings, non-negative levels.
#include <cmath>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "measure/prescription/nonnegative.h"
#include "measure/prescription/open_surfaces.h"
#include "measure/prescription/reflectance_fit.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

// Exact energies of ghosts between surfaces with these logarithms, each known to a per cent.
ReflectanceFit fit_of(const std::vector<GhostSurfaces>& ghosts, const std::vector<double>& x) {
  Eigen::VectorXd ratio(static_cast<Eigen::Index>(ghosts.size()));
  for (std::size_t k = 0; k < ghosts.size(); ++k) {
    double sum = 0.0;
    for (const int unknown : ghosts[k].unknown) sum += unknown >= 0 ? x[static_cast<std::size_t>(unknown)] : 0.0;
    ratio[static_cast<Eigen::Index>(k)] = std::exp(sum);
  }
  return fit_logarithms(ghosts, ratio, 0.01 * ratio, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(x.size())), {});
}

}  // namespace

TEST_CASE("reflectance fit: graphs of ghosts have the rank of their odd cycles") {
  const std::vector<double> x{0.5, -0.3, 0.2, -0.7};
  const std::vector<GhostSurfaces> path{{{0, 1}}, {{1, 2}}, {{2, 3}}};
  const std::vector<GhostSurfaces> even{{{0, 1}}, {{1, 2}}, {{2, 3}}, {{0, 3}}};
  const std::vector<GhostSurfaces> odd{{{0, 1}}, {{1, 2}}, {{0, 2}}, {{2, 3}}};
  CHECK(fit_of(path, x).rank == 3);
  CHECK(fit_of(even, x).rank == 3);
  const ReflectanceFit fit = fit_of(odd, x);
  CHECK(fit.rank == 4);
  CHECK(fit.open.empty());
  for (std::size_t k = 0; k < x.size(); ++k)
    CHECK(fit.x[static_cast<Eigen::Index>(k)] == test::approx(x[k]).epsilon(0.01));
  // A known reflectance at one end determines the path.
  const std::vector<GhostSurfaces> anchored{{{0, -1}}, {{0, 1}}, {{1, 2}}, {{2, 3}}};
  CHECK(fit_of(anchored, x).rank == 4);
}

TEST_CASE("reflectance fit: the warning names the sides of an even cycle, and surfaces without a ghost") {
  const std::vector<GhostSurfaces> even{{{0, 1}}, {{1, 2}}, {{2, 3}}, {{0, 3}}};
  const ReflectanceFit fit = fit_of(even, {0.5, -0.3, 0.2, -0.7, 0.0});
  CHECK(fit.rank == 3);
  CHECK(fit.error[4] > 1.0);
  const std::vector<int> surfaces{1, 3, 4, 6, 9};
  const auto texts = open_surface_texts(fit.open, surfaces);
  REQUIRE(texts.size() == 2);
  CHECK(texts[0].find("surfaces 1, 4 from those of 3, 6") != std::string::npos);
  CHECK(texts[1].find("surface 9") != std::string::npos);
}

TEST_CASE("reflectance fit: what the ghosts leave open is as expected") {
  const std::vector<GhostSurfaces> one{{{0, 1}}};
  const Eigen::VectorXd ratio = Eigen::VectorXd::Constant(1, std::exp(0.5));
  Eigen::VectorXd expected(3);
  expected << 0.4, 0.3, -0.6;
  const ReflectanceFit fit = fit_logarithms(one, ratio, 0.01 * ratio, expected, {});
  CHECK(fit.x[0] + fit.x[1] == test::approx(0.5).epsilon(0.01));
  CHECK(fit.x[0] - fit.x[1] == test::approx(0.1).epsilon(1e-9));
  CHECK(fit.x[2] == -0.6);
  CHECK(fit_logarithms({}, {}, {}, expected, {}).x == expected);
}

TEST_CASE("reflectance fit: a wrong energy among many counts little") {
  std::vector<GhostSurfaces> all;
  for (int i = 0; i < 5; ++i)
    for (int j = i + 1; j < 5; ++j) all.push_back({{i, j}});
  Eigen::VectorXd ratio = Eigen::VectorXd::Constant(static_cast<Eigen::Index>(all.size()), std::exp(0.4));
  ratio[3] *= 3.0;
  const ReflectanceFit fit = fit_logarithms(all, ratio, 0.01 * ratio, Eigen::VectorXd::Zero(5), {});
  for (int k = 0; k < 5; ++k) CHECK(fit.x[k] == test::approx(0.2).epsilon(0.1));
}

TEST_CASE("non-negative least squares: the conditions of Kuhn and Tucker hold") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> even(-1.0, 1.0);
  for (int trial = 0; trial < 50; ++trial) {
    Eigen::MatrixXd j(20, 8);
    Eigen::VectorXd y(20);
    for (Eigen::Index k = 0; k < j.size(); ++k) j.data()[k] = even(random);
    for (Eigen::Index k = 0; k < y.size(); ++k) y[k] = even(random);
    const Eigen::MatrixXd a = j.transpose() * j;
    const Eigen::VectorXd b = j.transpose() * y;
    const Eigen::VectorXd x = nonnegative_least_squares(a, b).x, gradient = a * x - b;
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      CHECK(x[k] >= 0.0);
      if (x[k] > 0.0)
        CHECK(std::abs(gradient[k]) < 1e-6);
      else
        CHECK(gradient[k] > -1e-6);
    }
  }
}
