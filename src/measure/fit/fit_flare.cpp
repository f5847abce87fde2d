// SPDX-License-Identifier: Apache-2.0
// The whole fit: halo, one ghost after another, then all of them together.
#include "contrejour/expert/fit_flare.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/tasks.h"
#include "measure/find/find_ghosts.h"
#include "measure/fit/amplitudes.h"
#include "measure/fit/clipped_ghosts.h"
#include "measure/fit/flare_fit_state.h"
#include "measure/fit/ghost_start.h"
#include "measure/fit/one_ghost.h"
#include "measure/fit/profiles.h"
#include "measure/fit/small_ghosts.h"
#include "measure/fit/station_figures.h"

namespace contrejour {
namespace {

constexpr double kHaloQuantile = 0.35, kMedian = 0.5;
constexpr int kLastIterations = 12;
constexpr std::size_t kTogetherEvery = 3;  // ghosts, after which all are fitted together
constexpr double kManySaturated = 0.05;  // of all pixels: so many deserve a warning
constexpr std::size_t kFewestToHoldOut = 10;  // stations in all, from which on some are held out

double cost_at(const FlareFit& fit, const std::vector<FitStation>& stations, const MeasuredFlare& flare) {
  FlareProblem problem(stations, flare);
  problem.huber = fit.options.huber;
  problem.context = fit.context;
  return problem.cost(problem.layout.pack(flare));
}

// Solves the levels of all ghosts for the outlines as they are. New ghosts are fitted by themselves, in windows less
// their surroundings. If they were added with these levels, they would have light that others have already, and a few
// steps of all unknowns together would not undo that.
void share_light(FlareFit& fit, const std::vector<FitStation>& stations) {
  AmplitudeSettings settings;
  settings.profile_coefficients = 0;
  settings.huber = fit.options.huber;
  MeasuredFlare shared = with_best_amplitudes(stations, fit.flare(), settings, fit.context);
  if (check_flare(shared) && cost_at(fit, stations, shared) < cost_at(fit, stations, fit.flare()))
    fit.flare() = std::move(shared);
}

void fit_together(FlareFit& fit, const std::vector<FitStation>& stations, double huber, int iterations) {
  share_light(fit, stations);
  const LevelFit l = optimised(fit, stations, fit.flare(), {huber, iterations, true});
  move_all(fit, l.centre_shift);
  fit.flare() = l.flare;
}

// Adds the ghost that a disc becomes to the flare.
bool add_ghost(FlareFit& fit, const std::vector<FitStation>& residuals, const FoundGhost& found) {
  std::optional<MeasuredGhost> ghost = fitted_alone(fit, residuals, found);
  if (!ghost) return false;
  ghost->name = fmt::format("{}", fit.flare().ghosts.size());
  fit.flare().ghosts.push_back(std::move(*ghost));
  return true;
}

std::optional<FoundGhost> searched(const FlareFit& fit, const std::vector<FitStation>& residuals,
                                   const std::vector<FoundGhost>& known) {
  const std::vector<SearchPicture> pictures = search_pictures(residuals, usual_error(residuals));
  return strongest_disc(pictures, {6.0, fit.options.min_contrast}, known, fit.context);
}

// Finds two thirds of the ghosts at most: dim ones under or beside these show only in what profiles leave.
void find_all(FlareFit& fit) {
  const int most = (2 * fit.options.max_ghosts + 2) / 3;
  std::vector<FoundGhost> known;
  std::size_t started = 0;
  int rejected = 0;
  while (static_cast<int>(fit.result.found.size()) < most && rejected < kMostRejected) {
    if (fit.context.cancelled()) return;
    const std::vector<FitStation> residuals = residual_stations(fit.coarse, fit.flare(), fit.context);
    const bool is_start = started < fit.options.starts.size();
    const auto found = is_start ? std::optional(fit.options.starts[started++]) : searched(fit, residuals, known);
    if (!found) return;
    known.push_back(*found);
    if (!add_ghost(fit, residuals, *found)) {
      rejected += is_start ? 0 : 1;
      continue;
    }
    rejected = 0;
    fit.result.found.push_back(*found);
    if (fit.result.found.size() % kTogetherEvery == 1) {
      share_light(fit, fit.coarse_samples);
      separate_halo(fit, kMedian);
      fit_together(fit, fit.coarse_samples, fit.options.huber, kTogetherIterations);
    }
  }
}

// The stations' figures, in the order of the sweep; sums: of all of them together.
std::vector<FittedStation> judged(const FlareFit& fit, bool held_out, ClearSums& sums) {
  const std::vector<FitStation>& fine = held_out ? fit.held_fine : fit.fine;
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
    const std::vector<bool> shown = shows_flux(station, fit.options.model_error);
    one.captured = flux_of(station.rate, shown);
    one.fitted = flux_of(model, shown);
    FitStation modelled = station;
    modelled.rate = model;
    parts[k] = clear_sums(half_size_station(station), half_size_station(modelled).rate);
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
  return cost_at(fit, stations, flare);
}

// As many coefficients as make the stations held out likeliest. More are tried from what fewer gave.
void choose_degree(FlareFit& fit) {
  if (fit.held_coarse.empty() || fit.result.found.empty()) return;
  double least = held_out_cost(fit, fit.flare(), 0.0);
  for (int degree = 1; degree <= fit.options.max_degree; ++degree) {
    const LevelFit more = optimised(fit, fit.coarse_samples, flare_of_degree(fit.flare(), degree),
                                    {fit.options.huber, kTogetherIterations, true});
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

// Joins both kinds of ghosts to one flare.
void add_small_ghosts(FlareFit& fit) {
  for (MeasuredGhost& ghost : fit.small) {
    ghost.name = fmt::format("{}", fit.flare().ghosts.size());
    fit.flare().ghosts.push_back(std::move(ghost));
  }
  fit.result.found.insert(fit.result.found.end(), fit.small_found.begin(), fit.small_found.end());
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
  if (geometry.focal_length_px < 0.0) {
    fit.result.warnings.emplace_back(
        "the light moves to the left as the angle grows: the angles' sign is swapped in the list");
  }
  find_small_ghosts(fit, (options.max_small_ghosts + 2) / 3);
  find_all(fit);
  find_small_ghosts(fit, (2 * options.max_small_ghosts + 2) / 3);  // the others: in what profiles leave
  if (fit.result.found.empty() && fit.small.empty())
    fit.result.warnings.emplace_back("no ghost was found: the pictures show none that stands out");
  if (context.progress) context.progress(0.5);
  share_light(fit, fit.coarse_samples);
  separate_halo(fit, kMedian);
  fit_together(fit, fit.coarse_samples, options.huber, kTogetherIterations);
  choose_degree(fit);
  fit_clipping(fit);
  fit_together(fit, fit.fine_samples, options.huber, kLastIterations);
  finish_small_ghosts(fit);
  add_small_ghosts(fit);
  fit_profiles(fit);
  if (context.cancelled()) return interrupted();
  const TangentFrame& frame = fit.fine.front().frame.pixels;
  fit.flare().half_field = {0.5 * frame.width / frame.focal_length_px, 0.5 * frame.height / frame.focal_length_px};
  drop_unbounded(fit);
  drop_veil_without_ghosts(fit);
  judge(fit);
  if (context.progress) context.progress(1.0);
  fit.result.centre_px = geometry.centre_px + Vec2{fit.centre_shift * std::abs(geometry.focal_length_px), 0.0};
  return fit.result;
}

}  // namespace contrejour
