// SPDX-License-Identifier: Apache-2.0
// The whole fit: halo, one ghost after another, then all of them together.
#include "contrejour/expert/fit_flare.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/tasks.h"
#include "measure/find/find_ghosts.h"
#include "measure/fit/flare_problem.h"
#include "measure/fit/ghost_start.h"
#include "measure/fit/halo.h"
#include "measure/fit/station_figures.h"
#include "measure/fit/stations.h"

namespace contrejour {
namespace {

constexpr double kHaloQuantile = 0.35, kMedian = 0.5;
constexpr int kAloneIterations = 25, kTogetherIterations = 8, kLastIterations = 25;
constexpr std::size_t kTogetherEvery = 3;  // ghosts, after which all are fitted together
constexpr double kLeastGain = 8.0;  // of the cost for each unknown of a new ghost: neighbouring pixels err alike
constexpr int kMostRejected = 4;    // in a row
constexpr double kNoHuber = 1e9, kFarHuber = 10.0;  // far from the solution every residual is an outlier
constexpr double kManySaturated = 0.05;  // of all pixels: so many deserve a warning
constexpr std::size_t kStationsOfOneFit = 10;  // to which a ghost is fitted alone
constexpr double kSeenMargin = 1.1;
constexpr double kMostShift = 0.05;  // of the optical centre, as a tangent
constexpr double kConverged = 2e-4;
constexpr std::size_t kFewestToHoldOut = 10;  // stations in all, from which on some are held out
// The widest fade outside a ghost, by blur in the picture and by the light's size times the ghost's speed: wider ones
// would stand for the background, or for a bright rim.
constexpr double kWidestFade_px = 0.7, kWidestFade = 0.003;

// The state of a fit.
struct FlareFit {
  FlareFitOptions options;
  Context context;
  SweepStations sweep, held_out;
  std::vector<std::size_t> fitted_of, held_of;  // stations of the sweep
  std::vector<FitStation> held_fine, held_coarse;
  // Without the halo: of the full reduced size and half of it, to be searched, and samples of both to be fitted.
  std::vector<FitStation> fine, coarse, coarse_samples, fine_samples;
  FittedFlare result;
  double centre_shift = 0;  // as a tangent

  [[nodiscard]] MeasuredFlare& flare() { return result.flare; }
};

std::vector<FitStation> half_size_stations(const std::vector<FitStation>& stations) {
  std::vector<FitStation> halves;
  for (const FitStation& station : stations) halves.push_back(half_size_station(station));
  return halves;
}

// The standard deviation of a usual pixel.
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

// Stations from which a flare has been subtracted.
std::vector<FitStation> residual_stations(const std::vector<FitStation>& stations, const MeasuredFlare& flare,
                                          const Context& context) {
  std::vector<FitStation> residuals = stations;
  parallel_for(stations.size(), context, [&](std::size_t k) {
    const Image model = model_of_station(flare, stations[k]);
    for (std::size_t i = 0; i < model.pixels.size(); ++i) residuals[k].rate.pixels[i] -= model.pixels[i];
  });
  return residuals;
}

// The halo of what the flare leaves, which is then subtracted from the pictures.
void separate_halo(FlareFit& fit, double quantile) {
  const std::vector<FitStation> residuals =
      fit.flare().ghosts.empty() ? fit.sweep.stations : residual_stations(fit.sweep.stations, fit.flare(), fit.context);
  const HaloProfile halo = halo_of(residuals, fit.sweep.lights_px, {fit.sweep.masked_px, quantile});
  fit.fine = stations_without(fit.sweep, halo, fit.options.model_error);
  fit.held_fine = stations_without(fit.held_out, halo, fit.options.model_error);
  fit.held_coarse = half_size_stations(fit.held_fine);
  fit.coarse = half_size_stations(fit.fine);
  fit.coarse_samples = sampled_stations(fit.coarse, 2);
  fit.fine_samples = sampled_stations(fit.fine, 4);
}

struct LevelFit {
  MeasuredFlare flare;
  double start_cost = 0, cost = 0;
  double centre_shift = 0;
};

Eigen::VectorXd with_last(const Eigen::VectorXd& from, double last) {
  Eigen::VectorXd all(from.size() + 1);
  all << from, last;
  return all;
}

// Moves the optical centre in all stations.
void move_all(FlareFit& fit, double centre_shift) {
  for (auto* stations : {&fit.sweep.stations, &fit.held_out.stations, &fit.fine, &fit.coarse, &fit.coarse_samples,
                         &fit.fine_samples, &fit.held_fine, &fit.held_coarse}) {
    for (FitStation& station : *stations) move_centre(station, centre_shift);
  }
  fit.centre_shift += centre_shift;
}

void limit_fades(const FlareProblem& problem, Eigen::VectorXd& upper) {
  constexpr std::size_t kWidthIn = 6, kWidthOut = 7;  // of curves_of()
  const double pixel = 1.0 / problem.stations.front().frame.pixels.focal_length_px;
  for (std::size_t k = 0; k < problem.flare.ghosts.size(); ++k) {
    const double half_width = problem.flare.ghosts[k].half_width(0.0);
    upper[problem.layout.curve_terms(k, kWidthIn, 0.0).first] = std::max(2.0 * pixel, 0.5 * half_width);
    upper[problem.layout.curve_terms(k, kWidthOut, 0.0).first] =
        kWidestFade_px * pixel + kWidestFade * std::abs(problem.flare.ghosts[k].centre.coefficients.front());
  }
}

LevelFit optimised(FlareFit& fit, const std::vector<FitStation>& stations, const MeasuredFlare& flare, double huber,
                   int iterations, bool with_centre = false) {
  FlareProblem problem(stations, flare);
  problem.with_centre = with_centre;
  problem.huber = huber;
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
  limit_fades(problem, squares.upper);
  if (with_centre) {
    start = with_last(start, 0.0);
    squares.lower = with_last(squares.lower, -kMostShift);
    squares.upper = with_last(squares.upper, kMostShift);
  }
  const LeastSquaresResult best = least_squares(squares, start, {iterations, kConverged});
  fit.result.image_evaluations += evaluations;
  const double shift = with_centre ? best.parameters[problem.layout.size()] : 0.0;
  return {problem.layout.unpack(flare, best.parameters), fit.result.progress.front().cost, best.cost, shift};
}

void fit_together(FlareFit& fit, const std::vector<FitStation>& stations, double huber, int iterations) {
  const LevelFit l = optimised(fit, stations, fit.flare(), huber, iterations, true);
  move_all(fit, l.centre_shift);
  fit.flare() = l.flare;
}

// A few stations, evenly spaced among those where the disc was seen.
std::vector<FitStation> few_stations(const std::vector<FitStation>& stations, const FoundGhost& found) {
  std::vector<FitStation> seen;
  for (const FitStation& station : stations) {
    if (station.s <= kSeenMargin * found.last) seen.push_back(station);
  }
  std::vector<FitStation> few;
  const std::size_t step = (seen.size() + kStationsOfOneFit - 1) / kStationsOfOneFit;
  for (std::size_t k = 0; k < seen.size(); k += std::max<std::size_t>(step, 1)) few.push_back(seen[k]);
  return few;
}

// Fits a ghost to what the others leave, and keeps it if the pictures become likelier by more than chance.
bool add_ghost(FlareFit& fit, const std::vector<FitStation>& all_residuals, const FoundGhost& found) {
  std::vector<FitStation> residuals = sampled_stations(few_stations(all_residuals, found), 2);
  MeasuredFlare alone = fit.flare();
  alone.ghosts = {start_of_ghost(found, residuals, alone.s_max)};
  alone.ghosts[0].name = fmt::format("{}", fit.flare().ghosts.size());
  const MeasuredFlare none{alone.name, alone.source, alone.s_max, alone.exposure, {}};
  const FlareProblem empty(residuals, none);
  const double before = empty.cost(Eigen::VectorXd(0));
  LevelFit best = optimised(fit, residuals, alone, kNoHuber, kAloneIterations);
  if (fit.result.found.empty()) {  // the first ghost says where the optical centre is
    best = optimised(fit, residuals, best.flare, kFarHuber, kAloneIterations, true);
    move_all(fit, best.centre_shift);
    for (FitStation& station : residuals) move_centre(station, best.centre_shift);
  }
  for (const double huber : {kFarHuber, fit.options.huber})
    best = optimised(fit, residuals, best.flare, huber, kAloneIterations);
  const auto unknowns = static_cast<double>(ParameterLayout(best.flare).size());
  if (fit.context.cancelled() || before - best.cost < kLeastGain * unknowns) return false;
  fit.flare().ghosts.push_back(best.flare.ghosts[0]);
  return true;
}

void find_all(FlareFit& fit) {
  std::vector<FoundGhost> known;
  int rejected = 0;
  while (static_cast<int>(fit.flare().ghosts.size()) <= fit.options.max_ghosts && rejected < kMostRejected) {
    if (fit.context.cancelled()) return;
    const std::vector<FitStation> residuals = residual_stations(fit.coarse, fit.flare(), fit.context);
    const std::vector<SearchPicture> pictures = search_pictures(residuals, usual_error(residuals));
    const auto found = strongest_disc(pictures, {6.0, fit.options.min_contrast}, known, fit.context);
    if (!found) return;
    known.push_back(*found);
    if (!add_ghost(fit, residuals, *found)) {
      ++rejected;
      continue;
    }
    rejected = 0;
    fit.result.found.push_back(*found);
    if (fit.result.found.size() % kTogetherEvery == 1) {
      separate_halo(fit, kMedian);
      fit_together(fit, fit.coarse_samples, fit.options.huber, kTogetherIterations);
    }
  }
}

// The stations' figures, in the order of the sweep; sums: of all of them together.
std::vector<FittedStation> judged(const FlareFit& fit, bool held_out, ClearSums& sums) {
  const std::vector<FitStation>& fine = held_out ? fit.held_fine : fit.fine;
  const std::vector<FitStation>& coarse = held_out ? fit.held_coarse : fit.coarse;
  std::vector<FittedStation> judged(fine.size());
  std::vector<ClearSums> parts(fine.size());
  const auto total = static_cast<double>(fit.fitted_of.size() + fit.held_of.size());
  parallel_for(fine.size(), fit.context, [&](std::size_t k) {
    FittedStation& one = judged[k];
    const FitStation& station = fine[k];
    one.station = (held_out ? fit.held_of : fit.fitted_of)[k];
    one.held_out = held_out;
    one.s = station.frame.to_light.x < 0.0 ? -station.s : station.s;
    Image model = model_of_station(fit.result.flare, station);
    one.captured = flux_of(station.rate, station);
    one.fitted = flux_of(model, station);
    parts[k] = clear_sums(coarse[k], model_of_station(fit.result.flare, coarse[k]));
    one.nrmse = parts[k].nrmse();
    const int pictures = fit.options.pictures;
    if (std::floor(static_cast<double>(one.station + 1) * pictures / total) <=
        std::floor(static_cast<double>(one.station) * pictures / total))
      return;
    one.captured_picture = fitted_part(station.rate, station);
    one.fitted_picture = fitted_part(std::move(model), station);
  });
  for (const ClearSums& part : parts) sums.left += part.left, sums.all += part.all;
  return judged;
}

void judge(FlareFit& fit) {
  ClearSums fitted, held;
  fit.result.stations = judged(fit, false, fitted);
  const std::vector<FittedStation> others = judged(fit, true, held);
  fit.result.stations.insert(fit.result.stations.end(), others.begin(), others.end());
  std::ranges::sort(fit.result.stations, {}, &FittedStation::station);
  fit.result.nrmse = fitted.nrmse();
  fit.result.held_out_nrmse = held.nrmse();
}

MeasuredFlare flare_of_degree(MeasuredFlare flare, int degree) {
  for (std::size_t k = 1; k < flare.ghosts.size(); ++k) flare.ghosts[k] = with_degree(flare.ghosts[k], degree);
  return flare;
}

// The cost at the stations held out.
double held_out_cost(const FlareFit& fit, const MeasuredFlare& flare, double centre_shift) {
  std::vector<FitStation> stations = fit.held_coarse;
  for (FitStation& station : stations) move_centre(station, centre_shift);
  FlareProblem problem(stations, flare);
  problem.huber = fit.options.huber;
  problem.context = fit.context;
  return problem.cost(problem.layout.pack(flare));
}

// As many coefficients as make the stations held out likeliest. More are tried from what fewer gave.
void choose_degree(FlareFit& fit) {
  if (fit.held_coarse.empty() || fit.result.found.empty()) return;
  double least = held_out_cost(fit, fit.flare(), 0.0);
  for (int degree = 1; degree <= fit.options.max_degree; ++degree) {
    const LevelFit more = optimised(fit, fit.coarse_samples, flare_of_degree(fit.flare(), degree), fit.options.huber,
                                    kTogetherIterations, true);
    const double cost = held_out_cost(fit, more.flare, more.centre_shift);
    if (fit.context.cancelled() || !(cost < least)) return;
    least = cost;
    fit.result.degree = degree;
    fit.flare() = more.flare;
    move_all(fit, more.centre_shift);
  }
}

// Takes the stations that are held out from those that are fitted.
void hold_out(FlareFit& fit) {
  SweepStations all = std::move(fit.sweep);
  fit.sweep = {{}, {}, all.masked_px, all.saturated};
  fit.held_out = {{}, {}, all.masked_px, all.saturated};
  const auto every = static_cast<std::size_t>(std::max(fit.options.held_out_every, 0));
  for (std::size_t k = 0; k < all.stations.size(); ++k) {
    const bool held = every > 0 && k % every == every / 2 && all.stations.size() >= kFewestToHoldOut;
    SweepStations& to = held ? fit.held_out : fit.sweep;
    to.stations.push_back(std::move(all.stations[k]));
    to.lights_px.push_back(all.lights_px[k]);
    (held ? fit.held_of : fit.fitted_of).push_back(k);
  }
}

// Light that is the same everywhere is no flare where there is no ghost.
void drop_veil_without_ghosts(FlareFit& fit) {
  if (fit.result.found.empty()) fit.flare().ghosts.clear();
}

}  // namespace

Result<FittedFlare> fit_flare(const FlareSweep& sweep, const SweepGeometry& geometry, const FlareFitOptions& options,
                              const Context& context) {
  FlareFit fit;
  fit.options = options;
  fit.context = context;
  fit.context.progress = nullptr;
  Result<SweepStations> stations = reduced_stations(sweep, geometry, options, fit.context);
  if (!stations) return tl::unexpected(stations.error());
  fit.sweep = std::move(*stations);
  hold_out(fit);
  separate_halo(fit, kHaloQuantile);
  for (const FitStation& station : fit.fine) fit.flare().s_max = std::max(fit.flare().s_max, station.s);
  fit.flare().ghosts.push_back(start_of_veil(fit.coarse, fit.flare().s_max));
  if (fit.sweep.saturated > kManySaturated) {
    fit.result.warnings.push_back(
        fmt::format("{:.0f} per cent of the pixels are saturated in every exposure: take shorter ones",
                    100.0 * fit.sweep.saturated));
  }
  find_all(fit);
  if (fit.result.found.empty())
    fit.result.warnings.emplace_back("no ghost was found: the pictures show none that stands out");
  if (context.progress) context.progress(0.5);
  separate_halo(fit, kMedian);
  fit_together(fit, fit.coarse_samples, options.huber, kTogetherIterations);
  choose_degree(fit);
  fit_together(fit, fit.fine_samples, options.huber, kLastIterations);
  if (context.cancelled()) return interrupted();
  const TangentFrame& frame = fit.fine.front().frame.pixels;
  fit.flare().half_field = {0.5 * frame.width / frame.focal_length_px, 0.5 * frame.height / frame.focal_length_px};
  drop_veil_without_ghosts(fit);
  judge(fit);
  if (context.progress) context.progress(1.0);
  fit.result.centre_px = geometry.centre_px + Vec2{fit.centre_shift * std::abs(geometry.focal_length_px), 0.0};
  return fit.result;
}

}  // namespace contrejour
