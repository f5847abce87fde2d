// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/clipped_ghosts.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "measure/fit/one_ghost.h"

namespace contrejour::inline internal {
namespace {

constexpr double kLeastRadius_px = 4.0;  // in half the size: the cut of a smaller ghost cannot be made out
constexpr double kStartRadius = 1.2;     // of a ghost's radius: the circle's, which leaves it whole on the axis
constexpr double kStartDepth = 0.8;  // of a ghost's radius: how far the circle has moved into it at the largest angle
constexpr std::size_t kClipBands = 2;  // coefficients of each of the circle's curves
constexpr int kSamples = 2;  // one pixel of this number is fitted in pictures of 320 pixels

// The disc that a ghost is on the axis, moving evenly: without what its outline took on to follow the cut.
MeasuredGhost plain_disc(MeasuredGhost ghost) {
  const double radius = ghost.half_height(0.0);
  for (AngleCurve* curve :
       {&ghost.centre, &ghost.half_width, &ghost.skew, &ghost.half_height, &ghost.roundness, &ghost.roundness_skew})
    std::fill(curve->coefficients.begin() + (curve->coefficients.empty() ? 0 : 1), curve->coefficients.end(), 0.0);
  for (AngleCurve* curve : {&ghost.skew, &ghost.roundness_skew})
    std::fill(curve->coefficients.begin(), curve->coefficients.end(), 0.0);
  for (AngleCurve* curve : {&ghost.half_width, &ghost.half_height}) curve->coefficients.front() = radius;
  ghost.roundness.coefficients.front() = kEllipseRoundness;
  return ghost;
}

// A circle concentric with the ghost on the axis, which moves into it from one side.
MeasuredGhost with_clip(MeasuredGhost ghost, double side, double s_max) {
  const double radius = ghost.half_height(0.0);
  ghost.last = s_max;
  ghost.clip_centre = ghost.centre;
  ghost.clip_centre.coefficients.resize(kClipBands, 0.0);
  ghost.clip_centre.coefficients[0] += side * (kStartRadius - 1.0 + kStartDepth) * radius / s_max;
  ghost.clip_radius.coefficients.assign(kClipBands, 0.0);
  ghost.clip_radius.coefficients[0] = kStartRadius * radius;
  return ghost;
}

double cost_of(const FlareFit& fit, const std::vector<FitStation>& stations, const MeasuredFlare& flare) {
  FlareProblem problem(stations, flare);
  problem.huber = fit.options.huber;
  problem.context = fit.context;
  return problem.cost(problem.layout.pack(flare));
}

// The pictures without the light of all other ghosts.
struct OtherResiduals {
  std::vector<FitStation> fitted, held;
};

OtherResiduals residuals_without(const FlareFit& fit, std::size_t ghost) {
  std::vector<MeasuredGhost> others = fit.flare().ghosts;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(ghost));
  const MeasuredFlare flare = fit.flare_of(std::move(others));
  const std::vector<FitStation> few =
      sampled_stations(few_stations(fit.coarse, fit.flare().s_max), fit.sampling(kSamples));
  return {residual_stations(few, flare, fit.context), residual_stations(fit.held_coarse, flare, fit.context)};
}

// The ghost with the circle that makes the pictures likeliest, or none if that is not likelier by more than chance.
std::optional<MeasuredGhost> clipped(FlareFit& fit, const OtherResiduals& residuals, const MeasuredGhost& ghost) {
  const MeasuredFlare plain = fit.flare_of({ghost});
  double least = cost_of(fit, residuals.fitted, plain) - kLeastGain * 2.0 * kClipBands;
  double least_held = cost_of(fit, residuals.held, plain);
  std::optional<MeasuredGhost> best;
  for (const double side : {-1.0, 1.0}) {
    LevelFit cut{fit.flare_of({with_clip(plain_disc(ghost), side, fit.flare().s_max)}), 0.0, 0.0};
    for (const double huber : {kNoHuber, kFarHuber, fit.options.huber})
      cut = optimised(fit, residuals.fitted, cut.flare, {huber, kAloneIterations});
    const double held = cost_of(fit, residuals.held, cut.flare);
    if (!check_flare(cut.flare)) continue;
    if (!(cut.cost < least) || (!residuals.held.empty() && !(held < least_held))) continue;
    least = cut.cost;
    least_held = held;
    best = cut.flare.ghosts[0];
  }
  return best;
}

}  // namespace

void fit_clipping(FlareFit& fit) {
  const double pixel = 1.0 / fit.coarse.front().frame.pixels.focal_length_px;
  for (std::size_t k = 1; k < fit.flare().ghosts.size() && !fit.context.cancelled(); ++k) {
    const MeasuredGhost& ghost = fit.flare().ghosts[k];
    if (ghost.half_height(0.0) < kLeastRadius_px * pixel) continue;
    auto cut = clipped(fit, residuals_without(fit, k), ghost);
    if (cut) fit.flare().ghosts[k] = std::move(*cut);
  }
}

}  // namespace contrejour::inline internal
