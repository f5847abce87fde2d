// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/film_design.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>

namespace contrejour {
namespace {

constexpr int kMaxCalls = 400;  // evaluations of the goal; each derivative takes one per film

// A film's thickness is the absolute value of its parameter, so that a step through 0 is reflected.
double thickness_of(double parameter) { return std::min(std::abs(parameter), kThickestFilm_nm); }

// The indices at one wavelength, computed once.
struct Spectral {
  std::vector<FilmLayer> layers;
  double glass = 1.0;
};

class Residuals {
 public:
  using Scalar = double;
  using InputType = Eigen::VectorXd;
  using ValueType = Eigen::VectorXd;
  using JacobianType = Eigen::MatrixXd;
  enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };

  Residuals(const FilmStack& start, const Glass& glass, const FilmGoal& goal)
      : goal_(goal), films_(static_cast<int>(start.layers.size())) {
    for (const double nm : goal.lambda_nm) {
      Spectral at{start.layers, refractive_index(glass, nm)};
      for (FilmLayer& layer : at.layers) layer.material = index_at(layer.material, nm);
      spectral_.push_back(std::move(at));
    }
    values_ = static_cast<int>(off(parameters(start)).size());
  }

  [[nodiscard]] static Eigen::VectorXd parameters(const FilmStack& stack) {
    Eigen::VectorXd x(static_cast<Eigen::Index>(stack.layers.size()));
    for (Eigen::Index k = 0; k < x.size(); ++k) x[k] = stack.layers[static_cast<std::size_t>(k)].thickness_nm;
    return x;
  }

  [[nodiscard]] int inputs() const { return films_; }
  // Eigen requires at least as many residuals as parameters: zeros are appended.
  [[nodiscard]] int values() const { return std::max(values_, films_); }

  int operator()(const Eigen::VectorXd& x, Eigen::VectorXd& out) const {
    const std::vector<double> all = off(x);
    out.setZero(values());
    for (std::size_t k = 0; k < all.size(); ++k) out[static_cast<Eigen::Index>(k)] = all[k];
    return 0;
  }

 private:
  [[nodiscard]] std::vector<double> off(const Eigen::VectorXd& x) const {
    std::vector<double> reflectance;
    for (std::size_t at = 0; at < spectral_.size(); ++at) {
      std::vector<FilmLayer> layers = spectral_[at].layers;
      for (std::size_t k = 0; k < layers.size(); ++k)
        layers[k].thickness_nm = thickness_of(x[static_cast<Eigen::Index>(k)]);
      const FilmResponse r = film_response(1.0, layers, spectral_[at].glass, 0.0, goal_.lambda_nm[at]);
      reflectance.push_back(r.R_s);
    }
    return goal_.off(reflectance);
  }

  const FilmGoal& goal_;
  int films_, values_ = 0;
  std::vector<Spectral> spectral_;
};

}  // namespace

std::vector<double> reflectances(const FilmStack& stack, const Glass& glass, std::span<const double> lambda_nm) {
  std::vector<double> out;
  for (const double nm : lambda_nm)
    out.push_back(film_response(1.0, stack.layers, refractive_index(glass, nm), 0.0, nm).R_s);
  return out;
}

FilmStack refined(const FilmStack& start, const Glass& glass, const FilmGoal& goal) {
  if (start.layers.empty() || goal.lambda_nm.empty() || !goal.off) return start;
  const Residuals residuals(start, glass, goal);
  Eigen::NumericalDiff<Residuals> differentiable(residuals, 1e-8);
  Eigen::LevenbergMarquardt<Eigen::NumericalDiff<Residuals>> method(differentiable);
  method.parameters.maxfev = kMaxCalls;
  Eigen::VectorXd x = Residuals::parameters(start);
  method.minimize(x);
  FilmStack out = start;
  for (std::size_t k = 0; k < out.layers.size(); ++k) {
    const double thickness = thickness_of(x[static_cast<Eigen::Index>(k)]);
    if (std::isfinite(thickness)) out.layers[k].thickness_nm = thickness;
  }
  return out;
}

}  // namespace contrejour
