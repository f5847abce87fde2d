// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/profiles.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "measure/find/find_ghosts.h"
#include "measure/find/find_small_ghosts.h"
#include "measure/fit/amplitudes.h"
#include "measure/fit/one_ghost.h"
#include "measure/fit/small_ghosts.h"

namespace contrejour::inline internal {
namespace {

constexpr std::array<std::size_t, 4> kCoefficients{2, 3, 4, 6};  // only the first where no station is held out
constexpr int kShapeIterations = 10;
constexpr int kMostFromResidual = 8;  // ghosts that the search after profiles may add
constexpr double kCountedOfDim = 1.0 / 16.0;  // of the usual error's square, in the search for wide dim ghosts
constexpr double kLeastHeldGain = 8.0;  // of the cost at the stations held out, for such a ghost
// One pixel of this number is fitted in pictures of 320 pixels: for levels, and for outlines, which are costly where
// ghosts with profiles overlap.
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

// The levels of the whole flare at the stations that are fitted, and what those held out say of them.
struct ProfileFit {
  FlareFit& fit;
  AmplitudeSettings settings;
  std::vector<FitStation> stations, held;
  std::optional<double> least;  // cost at the stations held out

  explicit ProfileFit(FlareFit& state)
      : fit(state), stations(sampled_stations(state.fine, state.sampling_of_all(kLevelSamples))),
        held(sampled_stations(state.held_fine, state.sampling_of_all(kLevelSamples))) {
    settings.huber = fit.options.huber;
    if (!held.empty()) least = held_cost(fit, held, fit.flare(), 0.0);
  }

  [[nodiscard]] MeasuredFlare with_levels(MeasuredFlare flare) const {
    return with_best_amplitudes(stations, std::move(flare), settings, fit.context);
  }

  // Keeps a flare if the stations held out are likelier under it by this much.
  bool keep(MeasuredFlare flare, double centre_shift, double gain = 0.0) {
    const double cost = least ? held_cost(fit, held, flare, centre_shift) : 0.0;
    if (fit.context.cancelled() || (least && !(cost < *least - gain))) return false;
    if (least) least = cost;
    fit.flare() = std::move(flare);
    if (centre_shift != 0.0) {
      move_all(fit, centre_shift);
      for (auto* all : {&stations, &held})
        for (FitStation& station : *all) move_centre(station, centre_shift);
    }
    return true;
  }
};

// Profiles with as many coefficients as make the stations held out likeliest. False if none helps.
bool choose_profiles(ProfileFit& all) {
  const MeasuredFlare start = with_diffuse_ghosts(all.fit.flare(), all.stations.front().frame.pixels);
  std::optional<std::size_t> best;
  for (const std::size_t count : kCoefficients) {
    all.settings.profile_coefficients = count;
    if (!all.keep(all.with_levels(start), 0.0)) break;
    best = count;
    if (!all.least) break;
  }
  if (best) all.settings.profile_coefficients = *best;
  return best.has_value();
}

// All outlines together, with the optical centre, then the levels once more.
void fit_shapes(ProfileFit& all) {
  FlareFit& fit = all.fit;
  const LevelFit shapes = optimised(fit, sampled_stations(fit.fine, fit.sampling_of_all(kShapeSamples), fit.flare()),
                                    fit.flare(), {fit.options.huber, kShapeIterations, true});
  std::vector<FitStation> moved = all.stations;
  for (FitStation& station : moved) move_centre(station, shapes.centre_shift);
  (void)all.keep(with_best_amplitudes(moved, shapes.flare, all.settings, fit.context), shapes.centre_shift);
}

// A ghost fitted by itself to what the flare leaves. Kept if the stations held out are likelier.
bool add_from_residual(ProfileFit& all, std::optional<MeasuredGhost> ghost, const FoundGhost& found) {
  if (!ghost) return false;
  MeasuredFlare more = all.fit.flare();
  const std::size_t at = 1 + all.fit.result.found.size();  // the diffuse ghosts come last
  ghost->name = fmt::format("{}", at);
  more.ghosts.insert(more.ghosts.begin() + static_cast<std::ptrdiff_t>(at), std::move(*ghost));
  if (!all.keep(std::move(more), 0.0, kLeastHeldGain)) return false;
  all.fit.result.found.push_back(found);
  return true;
}

// The search again, in the pictures that profiles leave: ghosts beside or under brighter ones show only now. Returns
// how many were found, `most` or fewer.
int search_residual(ProfileFit& all, int most, bool small, double counted_part = 1.0) {
  FlareFit& fit = all.fit;
  const GhostSearch search{6.0, fit.options.min_contrast};
  std::vector<FoundGhost> known;
  int added = 0;
  for (int rejected = 0; rejected < kMostRejected && added < most && !fit.context.cancelled();) {
    std::vector<FitStation> residuals = residual_stations(fit.fine, fit.flare(), fit.context);
    if (!small) residuals = half_size_stations(residuals);
    const std::vector<SearchPicture> pictures = search_pictures(residuals, usual_error(residuals), counted_part);
    const auto found = small ? strongest_spot(pictures, search, known, fit.context)
                             : strongest_disc(pictures, search, known, fit.context);
    if (!found) break;
    known.push_back(*found);
    const bool is_new = add_from_residual(
        all, small ? fitted_spot(fit, residuals, *found) : fitted_alone(fit, residuals, *found), *found);
    rejected = is_new ? 0 : rejected + 1;
    added += is_new ? 1 : 0;
  }
  return added;
}

// Removes ghosts without which the stations held out are likelier, the dimmest candidates being those found last.
void remove_dead(ProfileFit& all) {
  FlareFit& fit = all.fit;
  for (std::size_t k = fit.result.found.size(); k > 0 && all.least; --k) {
    MeasuredFlare fewer = fit.flare();
    fewer.ghosts.erase(fewer.ghosts.begin() + static_cast<std::ptrdiff_t>(k));
    if (all.keep(std::move(fewer), 0.0))
      fit.result.found.erase(fit.result.found.begin() + static_cast<std::ptrdiff_t>(k - 1));
  }
}

}  // namespace

void fit_profiles(FlareFit& fit) {
  if (fit.result.found.empty()) return;
  ProfileFit all(fit);
  if (!choose_profiles(all)) return;
  fit_shapes(all);
  if (!all.least) return;
  const auto small = static_cast<int>(fit.small_found.size());
  const int found = static_cast<int>(fit.result.found.size()) - small;
  const int most = std::min(kMostFromResidual, fit.options.max_ghosts - found);
  int added = search_residual(all, most, false);
  added += search_residual(all, most - added, false, kCountedOfDim);
  added += search_residual(all, std::min(kMostFromResidual, fit.options.max_small_ghosts - small), true);
  if (added == 0) return;
  // Profiles and diffuse ghosts have taken the new ones' light as far as they could, and give it back.
  (void)all.keep(all.with_levels(fit.flare()), 0.0);
  remove_dead(all);
  fit_shapes(all);
}

}  // namespace contrejour::inline internal
