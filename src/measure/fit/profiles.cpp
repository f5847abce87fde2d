// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/profiles.h"

#include <array>
#include <optional>
#include <utility>

#include "measure/fit/amplitudes.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kMostCoefficients = 3;
constexpr std::size_t kUsualCoefficients = 2;  // where no station is held out
constexpr int kShapeIterations = 10;
// One pixel of this number is fitted: for levels, and for outlines, which are costly where ghosts with profiles
// overlap.
constexpr int kLevelSamples = 3, kShapeSamples = 6;

// Wide ghosts of which no edge is found add up to light that changes slowly over the picture and moves with the light,
// or with some part of its distance. One ghost without an edge of its own stands for all of one speed.
struct Diffuse {
  const char* name;
  double speed, radius;  // radius: of the picture's width
};
constexpr double kDiffuseFade = 0.15;  // of the radius
constexpr std::array<Diffuse, 2> kDiffuse{{{"diffuse, about the light", 1.0, 0.35}, {"diffuse, wide", 0.0, 0.65}}};

MeasuredGhost diffuse_ghost(const Diffuse& diffuse, const TangentFrame& frame, double s_max) {
  MeasuredGhost ghost;
  ghost.name = diffuse.name;
  ghost.centre.coefficients = {diffuse.speed};
  ghost.half_width.coefficients = {diffuse.radius * frame.width / frame.focal_length_px};
  ghost.half_height.coefficients = ghost.half_width.coefficients;
  ghost.width_in.coefficients = {kDiffuseFade * ghost.half_height(0.0)};
  ghost.width_out.coefficients = {1.0 / frame.focal_length_px};
  ghost.last = s_max;
  return ghost;
}

MeasuredFlare with_diffuse_ghosts(MeasuredFlare flare, const TangentFrame& frame) {
  for (const Diffuse& diffuse : kDiffuse) flare.ghosts.push_back(diffuse_ghost(diffuse, frame, flare.s_max));
  return flare;
}

double held_cost(const FlareFit& fit, const std::vector<FitStation>& stations, const MeasuredFlare& flare,
                 double centre_shift) {
  std::vector<FitStation> moved = stations;
  for (FitStation& station : moved) move_centre(station, centre_shift);
  FlareProblem problem(moved, flare);
  problem.huber = fit.options.huber;
  problem.context = fit.context;
  return problem.cost(problem.layout.pack(flare));
}

}  // namespace

void fit_profiles(FlareFit& fit) {
  if (fit.result.found.empty()) return;
  std::vector<FitStation> stations = sampled_stations(fit.fine, kLevelSamples);
  const std::vector<FitStation> held = sampled_stations(fit.held_fine, kLevelSamples);
  AmplitudeSettings settings;
  settings.huber = fit.options.huber;
  MeasuredFlare start = with_diffuse_ghosts(fit.flare(), stations.front().frame.pixels);
  std::optional<double> least;
  if (!held.empty()) least = held_cost(fit, held, fit.flare(), 0.0);
  // Keeps a flare if the stations held out are likelier under it.
  const auto keep = [&](MeasuredFlare flare, double centre_shift) {
    const double cost = least ? held_cost(fit, held, flare, centre_shift) : 0.0;
    if (fit.context.cancelled() || (least && !(cost < *least))) return false;
    if (least) least = cost;
    fit.flare() = std::move(flare);
    move_all(fit, centre_shift);
    return true;
  };
  std::optional<std::size_t> best;
  for (std::size_t count = kUsualCoefficients; count <= (least ? kMostCoefficients : kUsualCoefficients); ++count) {
    settings.profile_coefficients = count;
    if (!keep(with_best_amplitudes(stations, start, settings, fit.context), 0.0)) break;
    best = count;
  }
  if (!best) return;
  settings.profile_coefficients = *best;
  const LevelFit shapes = optimised(fit, sampled_stations(fit.fine, kShapeSamples), fit.flare(),
                                    {fit.options.huber, kShapeIterations, true});
  for (FitStation& station : stations) move_centre(station, shapes.centre_shift);
  (void)keep(with_best_amplitudes(stations, shapes.flare, settings, fit.context), shapes.centre_shift);
}

}  // namespace contrejour::inline internal
