// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/flare_problem.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/tasks.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kChannels = 3;
constexpr auto kCurves = static_cast<Eigen::Index>(kGhostCurves);

struct GhostInStation {
  std::size_t index = 0;  // of the flare's ghosts
  GhostAtAngle at;
  double presence = 1.0;  // by which levels are multiplied: at the ends of a ghost's range
  std::vector<GhostPixel> pixels;
};

double presence_of(const MeasuredGhost& ghost, const GhostAtAngle& at, double s) {
  for (std::size_t c = 0; c < kChannels; ++c) {
    if (at.border[c] > 0.0) return at.border[c] / ghost.border[c](s);
    if (at.inside[c] > 0.0) return at.inside[c] / ghost.inside[c](s);
  }
  return 1.0;
}

std::vector<GhostInStation> ghosts_in(const MeasuredFlare& flare, const FitStation& station) {
  std::vector<GhostInStation> ghosts;
  for (std::size_t k = 0; k < flare.ghosts.size(); ++k) {
    const auto at = ghost_at(flare.ghosts[k], station.s, flare.s_max);
    if (!at) continue;
    ghosts.push_back({k, *at, presence_of(flare.ghosts[k], *at, station.s), ghost_pixels(*at, station.frame)});
  }
  return ghosts;
}

double area_of_pixel(const FitStation& station) {
  const double pixel = 1.0 / station.frame.pixels.focal_length_px;
  return pixel * pixel;
}

// Values of all pixels and channels.
std::vector<double> model_of(const std::vector<GhostInStation>& ghosts, const FitStation& station) {
  std::vector<double> model(station.rate.pixels.size(), 0.0);
  const double area = area_of_pixel(station);
  for (const GhostInStation& ghost : ghosts) {
    for (const GhostPixel& pixel : ghost.pixels) {
      for (std::size_t c = 0; c < kChannels; ++c) {
        const double level = ghost.at.border[c] * pixel.weights.border + ghost.at.inside[c] * pixel.weights.inside;
        model[kChannels * pixel.index + c] += area * level;
      }
    }
  }
  return model;
}

// A residual in standard deviations, its loss, and the factor by which robustness reduces its weight.
struct RobustTerm {
  double residual = 0, loss = 0, factor = 1;
};

RobustTerm robust_term(double difference, double weight, double huber) {
  const double residual = difference * std::sqrt(weight), size = std::abs(residual);
  if (size <= huber) return {residual, 0.5 * residual * residual, 1.0};
  return {residual, huber * (size - 0.5 * huber), huber / size};
}

double loss_of(const std::vector<double>& model, const FitStation& station, double huber) {
  double loss = 0.0;
  for (std::size_t k = 0; k < model.size(); ++k) {
    const auto weight = static_cast<double>(station.weight.pixels[k]);
    if (weight == 0.0) continue;
    loss += robust_term(model[k] - static_cast<double>(station.rate.pixels[k]), weight, huber).loss;
  }
  return loss;
}

// Derivatives of a pixel's value in one channel with respect to the values of all curves of a ghost.
using CurveGradient = Eigen::Matrix<double, kCurves, 1>;

CurveGradient gradient_of(const GhostInStation& ghost, const GhostPixel& pixel, std::size_t channel, double area) {
  CurveGradient gradient = CurveGradient::Zero();
  for (std::size_t k = 0; k < kShapeCurves; ++k) {
    gradient[static_cast<Eigen::Index>(k)] = area * (ghost.at.border[channel] * pixel.by_shape[k].border +
                                                     ghost.at.inside[channel] * pixel.by_shape[k].inside);
  }
  gradient[static_cast<Eigen::Index>(kShapeCurves + channel)] = area * ghost.presence * pixel.weights.border;
  gradient[static_cast<Eigen::Index>(kShapeCurves + kChannels + channel)] =
      area * ghost.presence * pixel.weights.inside;
  return gradient;
}

// Normal equations of one station for the values of the curves of its ghosts, in the order of `ghosts`.
NormalEquations station_equations(const std::vector<GhostInStation>& ghosts, const FitStation& station, double huber) {
  const auto size = kCurves * static_cast<Eigen::Index>(ghosts.size());
  const std::vector<double> model = model_of(ghosts, station);
  NormalEquations equations{loss_of(model, station, huber), Eigen::VectorXd::Zero(size),
                            Eigen::MatrixXd::Zero(size, size)};
  const double area = area_of_pixel(station);
  std::vector<std::vector<std::pair<Eigen::Index, const GhostPixel*>>> at_pixel(model.size() / kChannels);
  for (std::size_t g = 0; g < ghosts.size(); ++g) {
    for (const GhostPixel& pixel : ghosts[g].pixels)
      at_pixel[pixel.index].emplace_back(static_cast<Eigen::Index>(g), &pixel);
  }
  std::vector<CurveGradient> gradients;
  for (std::size_t index = 0; index < at_pixel.size(); ++index) {
    const auto& here = at_pixel[index];
    for (std::size_t c = 0; c < kChannels && !here.empty(); ++c) {
      const std::size_t k = kChannels * index + c;
      const auto weight = static_cast<double>(station.weight.pixels[k]);
      if (weight == 0.0) continue;
      const double difference = model[k] - static_cast<double>(station.rate.pixels[k]);
      const double w = weight * robust_term(difference, weight, huber).factor;
      gradients.clear();
      for (const auto& [g, pixel] : here)
        gradients.push_back(gradient_of(ghosts[static_cast<std::size_t>(g)], *pixel, c, area));
      for (std::size_t a = 0; a < here.size(); ++a) {
        const Eigen::Index row = kCurves * here[a].first;
        equations.gradient.segment<kCurves>(row) += w * difference * gradients[a];
        for (std::size_t b = a; b < here.size(); ++b) {
          equations.hessian.block<kCurves, kCurves>(row, kCurves * here[b].first) +=
              w * gradients[a] * gradients[b].transpose();
        }
      }
    }
  }
  return equations;
}

// The chain rule from curves' values at a station to the coefficients.
void add_station(const NormalEquations& station, const std::vector<GhostInStation>& ghosts,
                 const ParameterLayout& layout, double s, NormalEquations& sum) {
  sum.cost += station.cost;
  std::vector<ParameterLayout::CurveTerms> terms;
  for (const GhostInStation& ghost : ghosts) {
    for (std::size_t curve = 0; curve < kGhostCurves; ++curve)
      terms.push_back(layout.curve_terms(ghost.index, curve, s));
  }
  for (std::size_t a = 0; a < terms.size(); ++a) {
    for (std::size_t i = 0; i < terms[a].terms.size(); ++i) {
      const Eigen::Index row = terms[a].first + static_cast<Eigen::Index>(i);
      sum.gradient[row] += station.gradient[static_cast<Eigen::Index>(a)] * terms[a].terms[i];
      // Blocks of a ghost with a later one stand above the diagonal only.
      for (std::size_t b = a / kGhostCurves * kGhostCurves; b < terms.size(); ++b) {
        const double value = station.hessian(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b));
        if (value == 0.0) continue;
        const bool same_ghost = a / kGhostCurves == b / kGhostCurves;
        for (std::size_t j = 0; j < terms[b].terms.size(); ++j) {
          const Eigen::Index column = terms[b].first + static_cast<Eigen::Index>(j);
          sum.hessian(row, column) += value * terms[a].terms[i] * terms[b].terms[j];
          if (!same_ghost) sum.hessian(column, row) += value * terms[a].terms[i] * terms[b].terms[j];
        }
      }
    }
  }
}

// Adds the prior of the slopes' constant coefficients; `at`: the unknowns, `usual`: those of the flare given.
void add_prior(const FlareProblem& problem, const Eigen::VectorXd& at, const Eigen::VectorXd& usual,
               NormalEquations& sum) {
  constexpr std::array<std::size_t, 2> kSlopes{8, 9};
  const double weight = 1.0 / (problem.slope_error * problem.slope_error);
  for (std::size_t ghost = 0; ghost < problem.flare.ghosts.size(); ++ghost) {
    for (const std::size_t curve : kSlopes) {
      const ParameterLayout::CurveTerms terms = problem.layout.curve_terms(ghost, curve, 0.0);
      if (terms.terms.empty()) continue;
      const double off = at[terms.first] - usual[terms.first];
      sum.cost += 0.5 * weight * off * off;
      if (sum.gradient.size() == 0) continue;
      sum.gradient[terms.first] += weight * off;
      sum.hessian(terms.first, terms.first) += weight;
    }
  }
}

}  // namespace

double FlareProblem::cost(const Eigen::VectorXd& unknowns) const {
  const MeasuredFlare now = layout.unpack(flare, unknowns);
  double sum = 0.0;
  ordered_pipeline(
      stations.size(), context,
      [&](std::size_t k) { return loss_of(model_of(ghosts_in(now, stations[k]), stations[k]), stations[k], huber); },
      [&](std::size_t /*k*/, double loss) { sum += loss; });
  NormalEquations prior;
  add_prior(*this, unknowns, layout.pack(flare), prior);
  return sum + prior.cost;
}

NormalEquations FlareProblem::equations(const Eigen::VectorXd& unknowns) const {
  struct OfStation {
    std::vector<GhostInStation> ghosts;
    NormalEquations equations;
  };
  const MeasuredFlare now = layout.unpack(flare, unknowns);
  NormalEquations sum{0.0, Eigen::VectorXd::Zero(layout.size()), Eigen::MatrixXd::Zero(layout.size(), layout.size())};
  ordered_pipeline(
      stations.size(), context,
      [&](std::size_t k) {
        OfStation one;
        one.ghosts = ghosts_in(now, stations[k]);
        one.equations = station_equations(one.ghosts, stations[k], huber);
        return one;
      },
      [&](std::size_t k, const OfStation& one) { add_station(one.equations, one.ghosts, layout, stations[k].s, sum); });
  add_prior(*this, unknowns, layout.pack(flare), sum);
  return sum;
}

}  // namespace contrejour::inline internal
