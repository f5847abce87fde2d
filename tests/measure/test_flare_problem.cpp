// SPDX-License-Identifier: Apache-2.0
// The fit's derivatives against central differences, and a planted flare found again from a start beside it.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include "contrejour/expert/measured_flare.h"
#include "measure/fit/amplitudes.h"
#include "measure/fit/flare_fit_state.h"
#include "measure/fit/flare_problem.h"
#include "measure/random_ghosts.h"
#include "support/approx.h"

using namespace contrejour;
using contrejour::test::random_cut_ghost;
using contrejour::test::random_ghost;
using contrejour::test::random_ghost_with_profile;

namespace {

enum class Kind { Plain, Cut, WithProfile };

MeasuredFlare planted(int ghosts, unsigned seed, Kind kind = Kind::Plain) {
  std::mt19937 random(seed);
  MeasuredFlare flare{"planted", "", 0.5, std::nullopt, {}};
  for (int k = 0; k < ghosts; ++k) {
    MeasuredGhost ghost = kind == Kind::WithProfile ? random_ghost_with_profile(random)
                          : kind == Kind::Cut       ? random_cut_ghost(random)
                                                    : random_ghost(random);
    ghost.last = 0.5;
    ghost.width_in.coefficients[0] += 0.005;  // at least a pixel of these small pictures
    ghost.width_out.coefficients[0] += 0.005;
    for (std::size_t c = 0; c < 3; ++c) {
      ghost.border[c].coefficients[0] *= 1e6;
      ghost.inside[c].coefficients[0] *= 1e6;
      for (AngleCurve& term : ghost.profile[c])
        for (double& coefficient : term.coefficients) coefficient *= 1e6;
    }
    flare.ghosts.push_back(std::move(ghost));
  }
  return flare;
}

// Stations on both sides, as the flare's own pictures show them, with this standard deviation.
std::vector<FitStation> stations_of(const MeasuredFlare& flare, int count, double deviation, bool noisy) {
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  std::vector<FitStation> stations;
  for (int k = 0; k < count; ++k) {
    const double s = flare.s_max * (2.0 * (k + 0.5) / count - 1.0);
    FitStation station;
    station.s = std::abs(s);
    station.frame = {{96, 64, 90.0, {47.3, 32.8}}, {s < 0.0 ? -1.0 : 1.0, 0.0}};
    const FlareLight light{{s, 0.0}, {1.0, 1.0, 1.0}};
    station.rate = *render_measured(flare, std::span(&light, 1), station.frame.pixels);
    station.weight = Image(96, 64);
    for (std::size_t i = 0; i < station.rate.pixels.size(); ++i) {
      if (noisy) station.rate.pixels[i] += static_cast<float>(deviation * normal(random));
      station.weight.pixels[i] = static_cast<float>(1.0 / (deviation * deviation));
    }
    stations.push_back(std::move(station));
  }
  return stations;
}

}  // namespace

TEST_CASE("flare problem: gradients agree with central differences to 1e-5") {
  for (const auto& [huber, kind] :
       {std::pair{1e9, Kind::Plain}, {2.0, Kind::Plain}, {1e9, Kind::Cut}, {1e9, Kind::WithProfile}}) {
    const MeasuredFlare flare = planted(2, 2, kind);
    const auto stations = stations_of(flare, 3, 1.0, true);
    FlareProblem problem(stations, flare);
    problem.huber = huber;
    problem.with_centre =
        kind != Kind::WithProfile;  // a profile's own change with the angle is left out of the centre's
    Eigen::VectorXd at = problem.layout.pack(flare);
    if (problem.with_centre) {
      at.conservativeResize(at.size() + 1);
      at[at.size() - 1] = 0.004;
    }
    for (Eigen::Index k = 0; k < at.size(); ++k) at[k] *= 1.0 + 0.01 * std::sin(static_cast<double>(k));
    const NormalEquations equations = problem.equations(at);
    CHECK(equations.cost == test::approx(problem.cost(at)).epsilon(1e-12));
    const double scale = equations.gradient.cwiseProduct(at).cwiseAbs().maxCoeff();
    for (Eigen::Index k = 0; k < at.size(); ++k) {
      if (at[k] == 0.0) continue;
      const double step = 3e-6 * std::abs(at[k]);
      Eigen::VectorXd more = at, less = at;
      more[k] += step;
      less[k] -= step;
      const double difference = (problem.cost(more) - problem.cost(less)) / (2.0 * step);
      CHECK(std::abs(equations.gradient[k] - difference) * std::abs(at[k]) < 1e-5 * scale);
    }
    CHECK((equations.hessian - equations.hessian.transpose()).cwiseAbs().maxCoeff() <=
          1e-9 * equations.hessian.cwiseAbs().maxCoeff());
  }
}

TEST_CASE("flare problem: a planted flare is found from a start beside it [slow]") {
  const MeasuredFlare truth = planted(3, 5);
  const auto stations = stations_of(truth, 8, 0.5, true);
  FlareProblem problem(stations, truth);
  const Eigen::VectorXd at = problem.layout.pack(truth);
  Eigen::VectorXd start = at;
  for (Eigen::Index k = 0; k < start.size(); ++k) start[k] *= 1.0 + 0.04 * std::cos(3.0 * static_cast<double>(k));
  const LeastSquaresProblem squares{[&](const Eigen::VectorXd& p) { return problem.equations(p); },
                                    [&](const Eigen::VectorXd& p) { return problem.cost(p); }, problem.layout.lower(),
                                    problem.layout.upper()};
  problem.huber = 1e9;  // far from the solution every residual is an outlier
  const LeastSquaresResult near = least_squares(squares, start, {40, 1e-6});
  problem.huber = 3.0;
  const LeastSquaresResult fit = least_squares(squares, near.parameters, {20, 1e-8});
  CHECK(fit.cost <= problem.cost(at));
  const MeasuredFlare found = problem.layout.unpack(truth, fit.parameters);
  for (std::size_t k = 0; k < 3; ++k) {
    CHECK(found.ghosts[k].centre(0.4) == test::approx(truth.ghosts[k].centre(0.4)).epsilon(0.005));
    CHECK(found.ghosts[k].half_height(0.1) == test::approx(truth.ghosts[k].half_height(0.1)).epsilon(0.01));
  }
}

TEST_CASE("amplitudes: the levels of given outlines are found from any start, and none is below 0") {
  const MeasuredFlare truth = planted(3, 4, Kind::WithProfile);
  const auto stations = stations_of(truth, 8, 0.5, true);
  MeasuredFlare start = truth;
  for (MeasuredGhost& ghost : start.ghosts) {
    ghost.profile.fill({});
    for (AngleCurve& level : ghost.border) level.coefficients = {1.0};
  }
  AmplitudeSettings settings;
  settings.smoothness = 1e-6;
  settings.huber = 1e9;
  const MeasuredFlare found = with_best_amplitudes(stations, start, settings, {});
  const FlareLight light{{0.31, 0.0}, {1.0, 1.0, 1.0}};  // at none of the stations
  const Image a = *render_measured(truth, std::span(&light, 1), stations[0].frame.pixels);
  const Image b = *render_measured(found, std::span(&light, 1), stations[0].frame.pixels);
  double left = 0.0, all = 0.0;
  for (std::size_t k = 0; k < a.pixels.size(); ++k) {
    left += std::pow(static_cast<double>(a.pixels[k]) - static_cast<double>(b.pixels[k]), 2);
    all += std::pow(static_cast<double>(a.pixels[k]), 2);
  }
  CHECK(std::sqrt(left / all) < 0.03);
  for (const MeasuredGhost& ghost : found.ghosts) {
    CHECK(ghost.profile[0].size() == kProfileTerms);
    for (const FitStation& station : stations)
      for (const AngleCurve& level : ghost.border) CHECK(level(station.s) > -1e3);  // of 1e6
  }
  settings.profile_coefficients = 0;
  for (const MeasuredGhost& ghost : with_best_amplitudes(stations, start, settings, {}).ghosts)
    CHECK(ghost.profile[0].empty());
}

TEST_CASE("amplitudes: what is drawn is what was solved, so that the robust cost does not rise") {
  // Ghosts that overlap share their light as they like, unless none may fall below 0. Three have a hole each.
  for (const unsigned seed : {3U, 4U, 5U}) {
    MeasuredFlare start = planted(4, seed);
    for (MeasuredGhost& ghost : start.ghosts) ghost.centre.coefficients = {0.3 * ghost.centre.coefficients[0]};
    MeasuredFlare shown = start;
    for (std::size_t g = 1; g < shown.ghosts.size(); ++g) {
      for (std::size_t c = 0; c < 3; ++c) {
        shown.ghosts[g].profile[c].assign(kProfileTerms, {Parity::Even, {0.0}});
        for (std::size_t k = 0; k < 5; ++k) shown.ghosts[g].profile[c][k].coefficients = {-2e6};
      }
    }
    auto stations = stations_of(shown, 8, 20.0, true);
    std::mt19937 random(seed);
    for (FitStation& station : stations)
      for (float& value : station.rate.pixels) value += random() % 20U == 0U ? 1e3F : 0.0F;
    const AmplitudeSettings settings;
    const auto cost_of = [&](const MeasuredFlare& flare) {
      const FlareProblem problem(stations, flare);
      return problem.cost(problem.layout.pack(flare));
    };
    const MeasuredFlare found = with_best_amplitudes(stations, start, settings, {});
    CHECK(cost_of(found) < cost_of(start));
    CHECK(cost_of(with_best_amplitudes(stations, found, settings, {})) < 1.001 * cost_of(found));
    int below = 0, values = 0;
    for (const MeasuredGhost& ghost : found.ghosts) {
      for (std::size_t ring = 1; ring < kProfileRings && !ghost.profile[1].empty(); ++ring) {
        for (const FitStation& station : stations) {
          for (const double sign : {-1.0, 1.0}) {  // to the light, and away from it
            double level = 0.0;
            for (std::size_t m = 0; m < kProfileHarmonics; ++m)
              level += (m == 1 ? sign : 1.0) * ghost.profile[1][profile_index({m, ring})](station.s);
            below += level < -5e4 ? 1 : 0;  // of 1e6
            ++values;
          }
        }
      }
    }
    CHECK(values > 0);
    CHECK(below <= 0.02 * values);  // a sixth if nothing is held
  }
}

TEST_CASE("flare problem: a ghost without light in the pictures stays within its path and its radius of the start") {
  FlareFit fit;
  fit.result.flare.s_max = 0.5;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const MeasuredFlare flare = planted(1, seed);
    auto stations = stations_of(flare, 6, 1.0, true);
    std::mt19937 random(seed);
    std::normal_distribution<float> noise;
    for (FitStation& station : stations)
      for (float& value : station.rate.pixels) value = noise(random);
    MeasuredFlare start = flare;
    for (std::size_t c = 0; c < 3; ++c) {
      start.ghosts[0].border[c].coefficients = {1.0};  // a tenthousandth of a standard deviation
      start.ghosts[0].inside[c].coefficients = {1.0};
    }
    const LevelFit found = optimised(fit, stations, start, {1e9, 25});
    const double s = start.s_max, radius = start.ghosts[0].half_height(0.0);
    const double path = std::abs(start.ghosts[0].centre.coefficients[0]) * s;
    const double moved = (found.flare.ghosts[0].centre.coefficients[0] - start.ghosts[0].centre.coefficients[0]) * s;
    CHECK(std::abs(moved) <= 0.2 * path + 0.5 * radius + 1e-9);  // as docs/physics/measured-flare.md has it
  }
}

TEST_CASE("least squares: steps that the cost's noise hides are taken, and steps that raise it by more are not") {
  // A parabola with noise that changes with the parameter, however little that changes.
  const double noise = 0.3;
  LeastSquaresProblem problem;
  problem.equations = [&](const Eigen::VectorXd& at) {
    const double off = at[0] - 2.0;
    return NormalEquations{10.0 + 0.5 * off * off + noise * std::sin(1e6 * at[0]), Eigen::VectorXd::Constant(1, off),
                           Eigen::MatrixXd::Identity(1, 1)};
  };
  problem.cost = [&](const Eigen::VectorXd& at) { return problem.equations(at).cost; };
  // Beside the solution by as much as the cost does not show, at a place where the noise happens to be lowest.
  const double lowest = 1.5 + (1.5 * std::numbers::pi - std::fmod(1.5e6, 2.0 * std::numbers::pi)) * 1e-6;
  const Eigen::VectorXd start = Eigen::VectorXd::Constant(1, lowest);
  const LeastSquaresResult stuck = least_squares(problem, start, {30, 1e-4});
  CHECK(std::abs(stuck.parameters[0] - 2.0) > 0.1);
  const LeastSquaresResult found = least_squares(problem, start, {30, 1e-4, 2.0 * noise});
  CHECK(std::abs(found.parameters[0] - 2.0) < 0.01);
  CHECK(found.converged);
  CHECK(found.iterations < 10);
  problem.equations = [](const Eigen::VectorXd& at) {  // a gradient that is wrong: the cost rises along every step
    return NormalEquations{1.0 + 5.0 * std::abs(at[0]), Eigen::VectorXd::Constant(1, at[0] >= 0.0 ? -1.0 : 1.0),
                           Eigen::MatrixXd::Identity(1, 1)};
  };
  CHECK(std::abs(least_squares(problem, Eigen::VectorXd::Zero(1), {30, 1e-4, 0.1}).parameters[0]) < 0.2);
}

TEST_CASE("least squares: parameters that depend on one another move along a bound, and none stops short of it") {
  // 0.5 d^T H d about (-1, 1.5), which x >= 0 leaves out. With x = 0, y = 1.5 - 0.99. A step cut off at the bound, to
  // (0, 1.5), would raise the cost from 0.02 to 0.5.
  const Eigen::Vector2d free_solution(-1.0, 1.5);
  Eigen::Matrix2d hessian;
  hessian << 1.0, 0.99, 0.99, 1.0;
  LeastSquaresProblem problem;
  problem.equations = [&](const Eigen::VectorXd& at) {
    const Eigen::VectorXd off = at - free_solution, gradient = hessian * off;
    return NormalEquations{0.5 * off.dot(gradient), gradient, hessian};
  };
  problem.cost = [&](const Eigen::VectorXd& at) { return problem.equations(at).cost; };
  problem.lower = Eigen::Vector2d(0.0, -10.0);
  problem.upper = Eigen::Vector2d(10.0, 10.0);
  const LeastSquaresResult found = least_squares(problem, Eigen::Vector2d(0.5, 0.0), {30, 1e-9});
  CHECK(found.converged);
  CHECK(found.parameters[0] == 0.0);
  CHECK(std::abs(found.parameters[1] - 0.51) < 1e-4);
}

TEST_CASE("flare problem: a ghost that grows by more than a fit may change it keeps what it has") {
  MeasuredFlare flare = planted(1, 9);
  flare.ghosts.resize(1);
  AngleCurve& height = flare.ghosts[0].half_height;
  height.coefficients.resize(2);
  height.coefficients[1] =
      0.8 * height.coefficients[0] / (flare.s_max * flare.s_max);  // 0.5 of the radius is the bound
  FlareFit fit;
  const auto stations = stations_of(flare, 6, 1.0, false);
  const LevelFit found = optimised(fit, stations, flare, {3.0, 1});
  FlareProblem problem(stations, flare);
  CHECK(fit.result.progress.front().cost == problem.cost(problem.layout.pack(flare)));
  CHECK(found.cost <= fit.result.progress.front().cost);
}

TEST_CASE("flare problem: the same bits for any number of threads") {
  const MeasuredFlare flare = planted(4, 7);
  const auto stations = stations_of(planted(4, 8), 6, 1.0, true);
  FlareProblem one(stations, flare), four(stations, flare);
  one.context.threads = 1;
  four.context.threads = 4;
  const Eigen::VectorXd at = one.layout.pack(flare);
  CHECK(one.cost(at) == four.cost(at));
  CHECK(one.equations(at).hessian == four.equations(at).hessian);
}
