// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/flare_fit_state.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/tasks.h"
#include "measure/fit/halo.h"
#include "measure/fit/station_figures.h"
#include "measure/model/flare_curves.h"

namespace contrejour::inline internal {
namespace {

constexpr double kMostShift = 0.05;  // of the optical centre, as a tangent
constexpr double kConverged = 2e-4;
constexpr double kUsualWidth = 320.0;  // of pictures, for which numbers of samples are given
constexpr double kUsualStations = 49.0;  // the same: that are fitted of 61
// The widest fade outside a ghost, by blur in the picture and by the light's size times the ghost's speed: wider ones
// would stand for the background, or for a bright rim. A small ghost's window has no background left.
constexpr double kWidestFade_px = 0.7, kWidestFade = 0.003, kWidestOfSmall = 0.6;
// The least half axis of a small ghost: four squares across a pixel describe no smaller one.
constexpr double kLeastHalfAxis_px = 0.25;
constexpr double kCutPart = 0.5;  // of a cut ghost's radius: how far each of its coefficients may move in one fit
// Fractions of its radius by which a small ghost, and a disc that is fitted by itself, may move in one fit, in addition
// to a pixel.
constexpr double kNearPart = 0.35, kNearPartOfDisc = 0.15;

Eigen::VectorXd with_last(const Eigen::VectorXd& from, double last) {
  Eigen::VectorXd all(from.size() + 1);
  all << from, last;
  return all;
}

// By how much a ghost may leave the disc that moves evenly (coefficients beyond the first), and its centre the one that
// a fit starts from. Without bounds, one that stands for light of another kind takes any shape at angles where little
// holds it, and one that has no light goes anywhere.
constexpr double kBend = 0.2, kBendOfRadius = 0.5;  // of the way that the centre moves, and of the radius
constexpr double kGrowth = 0.5, kSkew = 0.4;  // of the radius
constexpr double kRoundnessChange = 0.15, kFadeChange = 0.3;  // the latter of the radius

// A ghost changes smoothly and by parts of its own size.
void keep_plausible(const FlareProblem& problem, std::size_t ghost, LeastSquaresProblem& squares) {
  constexpr std::size_t kBounded = 8;  // of curves_of(): place, shape and widths of fades
  const MeasuredGhost& g = problem.flare.ghosts[ghost];
  const Eigen::VectorXd start = problem.layout.pack(problem.flare);  // within the bounds: a fit begins with what it has
  const double radius = g.half_height(0.0);
  const double path = std::abs(g.centre.coefficients.front()) * problem.flare.s_max;
  const std::array<double, kBounded> most{kBend * path + kBendOfRadius * radius,
                                          kGrowth * radius,
                                          kSkew * radius,
                                          kGrowth * radius,
                                          kRoundnessChange,
                                          kRoundnessChange,
                                          kFadeChange * radius,
                                          kFadeChange * radius};
  for (std::size_t curve = 0; curve < kBounded; ++curve) {
    const ParameterLayout::CurveTerms terms = problem.layout.curve_terms(ghost, curve, 0.0);
    const bool is_skew = curve == 2 || curve == 5;
    for (std::size_t k = is_skew ? 0 : 1; k < terms.terms.size(); ++k) {
      const Eigen::Index at = terms.first + static_cast<Eigen::Index>(k);
      squares.lower[at] = std::max(squares.lower[at], std::min(-most[curve], start[at]));
      squares.upper[at] = std::min(squares.upper[at], std::max(most[curve], start[at]));
    }
  }
  const Eigen::Index centre = problem.layout.curve_terms(ghost, 0, 0.0).first;
  squares.lower[centre] = std::max(squares.lower[centre], start[centre] - most[0]);
  squares.upper[centre] = std::min(squares.upper[centre], start[centre] + most[0]);
}

// A ghost that is fitted in a window stays near its start, because the window shows parts of others, too.
void keep_near(const FlareProblem& problem, std::size_t ghost, double part, LeastSquaresProblem& squares) {
  constexpr std::array<std::size_t, 4> kShape{0, 1, 2, 3};  // of curves_of(): centre, half width, skew, half height
  const double pixel = 1.0 / problem.stations.front().frame.pixels.focal_length_px;
  const Eigen::VectorXd start = problem.layout.pack(problem.flare);
  const double radius = problem.flare.ghosts[ghost].half_height(0.0);
  for (const std::size_t curve : kShape) {
    const ParameterLayout::CurveTerms terms = problem.layout.curve_terms(ghost, curve, 0.0);
    const bool is_size = curve == 1 || curve == 3;
    for (std::size_t k = 0; k < terms.terms.size(); ++k) {
      const Eigen::Index at = terms.first + static_cast<Eigen::Index>(k);
      const double most = curve == 0 ? pixel + part * radius : part * radius;
      squares.lower[at] = start[at] - most;
      squares.upper[at] = start[at] + most;
      if (is_size && k == 0) squares.lower[at] = std::max(squares.lower[at], kLeastHalfAxis_px * pixel);
      squares.upper[at] = std::max(squares.upper[at], squares.lower[at]);
    }
  }
}

// A ghost that a circle cuts stays near its start, too: a circle that leaves nothing of it would leave its curves free.
void keep_cut_near(const FlareProblem& problem, std::size_t ghost, LeastSquaresProblem& squares) {
  constexpr std::array<std::size_t, 6> kPlace{0, 1, 2, 3, kClipCentre, kClipRadius};
  const Eigen::VectorXd start = problem.layout.pack(problem.flare);
  const double most = kCutPart * problem.flare.ghosts[ghost].half_height(0.0);
  for (const std::size_t curve : kPlace) {
    const ParameterLayout::CurveTerms terms = problem.layout.curve_terms(ghost, curve, 0.0);
    for (Eigen::Index at = terms.first; at < terms.first + static_cast<Eigen::Index>(terms.terms.size()); ++at) {
      squares.lower[at] = std::max(squares.lower[at], start[at] - most);
      squares.upper[at] = std::min(squares.upper[at], start[at] + most);
    }
  }
}

// Bounds of fades and of small ghosts' sizes, relative to the picture's pixels.
void limit_shape(const FlareProblem& problem, const LevelSettings& settings, LeastSquaresProblem& squares) {
  const bool small = settings.small;
  constexpr std::size_t kHalfWidth = 1, kHalfHeight = 3, kWidthIn = 6, kWidthOut = 7;  // of curves_of()
  const double pixel = 1.0 / problem.stations.front().frame.pixels.focal_length_px;
  for (std::size_t k = 0; k < problem.flare.ghosts.size(); ++k) {
    const MeasuredGhost& ghost = problem.flare.ghosts[k];
    const auto constant_of = [&](std::size_t curve) { return problem.layout.curve_terms(k, curve, 0.0).first; };
    const double half_width = ghost.half_width(0.0);
    squares.upper[constant_of(kWidthIn)] = std::max(2.0 * pixel, 0.5 * half_width);
    const double widest = kWidestFade_px * pixel + kWidestFade * std::abs(ghost.centre.coefficients.front());
    const double now = ghost.width_out(0.0);  // a small ghost that has become one of all keeps its fade
    squares.upper[constant_of(kWidthOut)] =
        std::max(now, small ? std::max(widest, kWidestOfSmall * half_width) : widest);
    for (const std::size_t axis : {kHalfWidth, kHalfHeight})
      squares.lower[constant_of(axis)] = std::max(squares.lower[constant_of(axis)], kLeastHalfAxis_px * pixel);
    keep_plausible(problem, k, squares);
    if (small) keep_near(problem, k, kNearPart, squares);
    if (settings.near_start) keep_near(problem, k, kNearPartOfDisc, squares);
    if (!ghost.clip_radius.coefficients.empty()) keep_cut_near(problem, k, squares);
  }
}

std::vector<double> deviations_of(const HaloProfile& halo, const std::vector<FitStation>& residuals,
                                  const SweepStations& sweep) {
  std::vector<double> deviations;
  for (std::size_t k = 0; k < residuals.size(); ++k)
    deviations.push_back(halo_deviation(halo, residuals[k], sweep.lights_px[k], sweep.masked_px));
  return deviations;
}

}  // namespace

int FlareFit::sampling(int every) const {
  const double larger = (sweep.stations.empty() ? 0.0 : sweep.stations.front().rate.width) / kUsualWidth;
  return every * std::max(1, static_cast<int>(std::lround(larger * larger)));
}

int FlareFit::sampling_of_all(int every) const {
  const double more = static_cast<double>(sweep.stations.size()) / kUsualStations;
  return sampling(every * std::max(1, static_cast<int>(std::lround(more))));
}

MeasuredFlare FlareFit::flare_of(std::vector<MeasuredGhost> ghosts) const {
  return {result.flare.name, result.flare.source, result.flare.s_max, result.flare.exposure, std::move(ghosts)};
}

std::vector<FitStation> half_size_stations(const std::vector<FitStation>& stations) {
  std::vector<FitStation> halves;
  for (const FitStation& station : stations) halves.push_back(half_size_station(station));
  return halves;
}

double usual_error(const std::vector<FitStation>& stations) {
  std::vector<float> weights;
  for (const FitStation& station : stations) {
    for (const float weight : station.weight.pixels) {
      if (weight > 0.0F) weights.push_back(weight);
    }
  }
  if (weights.empty()) return 1.0;
  const auto middle = weights.begin() + static_cast<std::ptrdiff_t>(weights.size() / 2);
  std::nth_element(weights.begin(), middle, weights.end());
  return 1.0 / std::sqrt(static_cast<double>(*middle));
}

std::vector<FitStation> residual_stations(std::vector<FitStation> stations, const MeasuredFlare& flare,
                                          const Context& context) {
  if (flare.ghosts.empty()) return stations;
  parallel_for(stations.size(), context, [&](std::size_t k) {
    const Image model = model_of_station(flare, stations[k]);
    for (std::size_t i = 0; i < model.pixels.size(); ++i) stations[k].rate.pixels[i] -= model.pixels[i];
  });
  return stations;
}

void subtract_small_ghosts(FlareFit& fit) {
  const MeasuredFlare small = fit.flare_of(fit.small);
  const std::vector<FitStation> fine = residual_stations(fit.fine, small, fit.context);
  fit.coarse = half_size_stations(fine);
  fit.coarse_samples = sampled_stations(fit.coarse, fit.sampling_of_all(2));
  fit.fine_samples = sampled_stations(fine, fit.sampling_of_all(4));
  fit.held_coarse = half_size_stations(residual_stations(fit.held_fine, small, fit.context));
}

void separate_halo(FlareFit& fit, double quantile) {
  std::vector<MeasuredGhost> all = fit.flare().ghosts;
  all.insert(all.end(), fit.small.begin(), fit.small.end());
  const MeasuredFlare flare = fit.flare_of(std::move(all));
  const std::vector<FitStation> residuals = residual_stations(fit.sweep.stations, flare, fit.context);
  const HaloProfile halo = halo_of(residuals, fit.sweep.lights_px, {fit.sweep.masked_px, quantile});
  const std::vector<FitStation> held_residuals = residual_stations(fit.held_out.stations, flare, fit.context);
  fit.fine = stations_without(fit.sweep, halo, fit.options.model_error, deviations_of(halo, residuals, fit.sweep));
  fit.held_fine =
      stations_without(fit.held_out, halo, fit.options.model_error, deviations_of(halo, held_residuals, fit.held_out));
  subtract_small_ghosts(fit);
}

void move_all(FlareFit& fit, double centre_shift) {
  for (auto* stations : {&fit.sweep.stations, &fit.held_out.stations, &fit.fine, &fit.coarse, &fit.coarse_samples,
                         &fit.fine_samples, &fit.held_fine, &fit.held_coarse}) {
    for (FitStation& station : *stations) move_centre(station, centre_shift);
  }
  fit.centre_shift += centre_shift;
}

void drop_unbounded(FlareFit& fit) {
  const std::size_t dropped = std::erase_if(
      fit.flare().ghosts, [&](const MeasuredGhost& ghost) { return !check_flare(fit.flare_of({ghost})); });
  if (dropped > 0)
    fit.result.warnings.push_back(
        fmt::format("{} fitted ghosts had values beyond all limits and were left out", dropped));
}

LevelFit optimised(FlareFit& fit, const std::vector<FitStation>& stations, const MeasuredFlare& flare,
                   const LevelSettings& settings) {
  FlareProblem problem(stations, flare);
  problem.with_centre = settings.with_centre;
  problem.huber = settings.huber;
  problem.context = fit.context;
  const auto count = static_cast<double>(stations.size());
  fit.result.progress.clear();
  double evaluations = 0.0;
  const auto counted = [&](double cost) {
    evaluations += count;
    fit.result.progress.push_back({evaluations, cost});
  };
  LeastSquaresProblem squares{[&](const Eigen::VectorXd& p) {
                                NormalEquations equations = problem.equations(p);
                                counted(equations.cost);
                                return equations;
                              },
                              [&](const Eigen::VectorXd& p) {
                                const double cost = problem.cost(p);
                                counted(cost);
                                return cost;
                              },
                              problem.layout.lower(), problem.layout.upper()};
  Eigen::VectorXd start = problem.layout.pack(flare);
  limit_shape(problem, settings, squares);
  if (settings.with_centre) {
    start = with_last(start, 0.0);
    squares.lower = with_last(squares.lower, -kMostShift);
    squares.upper = with_last(squares.upper, kMostShift);
  }
  const LeastSquaresResult best = least_squares(squares, start, {settings.iterations, kConverged});
  fit.result.image_evaluations += evaluations;
  const double shift = settings.with_centre ? best.parameters[problem.layout.size()] : 0.0;
  return {problem.layout.unpack(flare, best.parameters), best.cost, shift};
}

}  // namespace contrejour::inline internal
