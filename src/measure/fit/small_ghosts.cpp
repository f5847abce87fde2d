// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/small_ghosts.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "measure/find/find_small_ghosts.h"
#include "measure/fit/ghost_start.h"
#include "measure/fit/stations.h"

namespace contrejour::inline internal {
namespace {

// A window reaches to kWindowPart * radius + kWindow_px; its part above and below from kAroundPart * radius +
// kAround_px on is what surrounds the ghost.
constexpr double kWindowPart = 2.2, kWindow_px = 4.0, kAroundPart = 1.4, kAround_px = 2.0;
constexpr int kFewestAround = 6;  // pixels, for a level to be known
constexpr double kSpotRange = 1.1;  // of the range where a spot was seen: the ghost may be there
constexpr std::size_t kWithNeighbours = 3;  // ghosts, after which all small ones are fitted together

// A ghost's place at a station, as tangents.
struct SpotPlace {
  double centre = 0, radius = 0;
};

std::optional<SpotPlace> place_of(const FoundGhost& found, double s) {
  if (s > kSpotRange * found.last) return std::nullopt;
  return SpotPlace{s * (found.speed + found.bend * s * s), found.radius};
}

std::optional<SpotPlace> place_of(const MeasuredGhost& ghost, double s) {
  if (s > ghost.last) return std::nullopt;
  return SpotPlace{ghost.centre(s), std::max(ghost.half_width(s), ghost.half_height(s))};
}

// The level above and below a ghost, of the pixels that count; none where they are too few.
std::optional<double> level_around(const FitStation& window, Vec2 middle, double inner_px, int channel) {
  const Vec2 along{window.frame.to_light.x, -window.frame.to_light.y};
  double sum = 0.0;
  int count = 0;
  for (int y = 0; y < window.rate.height; ++y) {
    for (int x = 0; x < window.rate.width; ++x) {
      const Vec2 offset = Vec2{x + 0.5, y + 0.5} - middle;
      const bool around = length(offset) > inner_px && std::abs(cross(along, offset)) > std::abs(dot(along, offset));
      if (!around || window.weight.at(x, y, channel) == 0.0F) continue;
      sum += static_cast<double>(window.rate.at(x, y, channel));
      ++count;
    }
  }
  return count < kFewestAround ? std::nullopt : std::optional(sum / count);
}

// The part of a station about a ghost, without its surroundings' level. `taken`: pixels of other windows, which do not
// count again; this window's are added.
std::optional<FitStation> window_about(const FitStation& station, const SpotPlace& place, Image& taken) {
  const TangentFrame& frame = station.frame.pixels;
  const Vec2 along{station.frame.to_light.x, -station.frame.to_light.y};
  Vec2 middle = frame.centre_px + along * (place.centre * frame.focal_length_px);
  const double radius = place.radius * frame.focal_length_px, reach = kWindowPart * radius + kWindow_px;
  const auto within = [](double at, int size) {
    return static_cast<int>(std::clamp(at, 0.0, static_cast<double>(size)));
  };
  const int left = within(std::floor(middle.x - reach), frame.width), right = within(middle.x + reach, frame.width);
  const int top = within(std::floor(middle.y - reach), frame.height), bottom = within(middle.y + reach, frame.height);
  if (right - left < 3 || bottom - top < 3) return std::nullopt;
  const Vec2 corner{static_cast<double>(left), static_cast<double>(top)};
  FitStation window;
  window.s = station.s;
  window.frame.pixels = {right - left, bottom - top, frame.focal_length_px, frame.centre_px - corner};
  window.frame.to_light = station.frame.to_light;
  window.rate = Image(right - left, bottom - top);
  window.weight = window.rate;
  middle = middle - corner;
  for (int y = 0; y < bottom - top; ++y) {
    for (int x = 0; x < right - left; ++x) {
      float& is_taken = taken.at(left + x, top + y);
      const bool counts = is_taken == 0.0F && length(Vec2{x + 0.5, y + 0.5} - middle) <= reach;
      if (counts) is_taken = 1.0F;
      for (int c = 0; c < 3; ++c) {
        window.rate.at(x, y, c) = station.rate.at(left + x, top + y, c);
        window.weight.at(x, y, c) = counts ? station.weight.at(left + x, top + y, c) : 0.0F;
      }
    }
  }
  for (int c = 0; c < 3; ++c) {
    const auto around = level_around(window, middle, kAroundPart * radius + kAround_px, c);
    if (!around) return std::nullopt;
    for (int y = 0; y < window.rate.height; ++y)
      for (int x = 0; x < window.rate.width; ++x) window.rate.at(x, y, c) -= static_cast<float>(*around);
  }
  guess_channels(window);
  return window;
}

// The windows of ghosts, or of spots, in all stations where they are.
template <class Places>
std::vector<FitStation> windows_about(const std::vector<FitStation>& stations, const Places& ghosts) {
  std::vector<FitStation> windows;
  for (const FitStation& station : stations) {
    Image taken(station.rate.width, station.rate.height, 1);
    for (const auto& ghost : ghosts) {
      const auto place = place_of(ghost, station.s);
      auto window = place ? window_about(station, *place, taken) : std::nullopt;
      if (window) windows.push_back(std::move(*window));
    }
  }
  return windows;
}

// All small ghosts together, and the optical centre with them, which they determine well.
void fit_small_together(FlareFit& fit, int iterations) {
  const std::vector<FitStation> windows =
      windows_about(residual_stations(fit.fine, fit.flare(), fit.context), fit.small);
  if (windows.empty()) return;
  const LevelFit best = optimised(fit, windows, fit.flare_of(fit.small), {fit.options.huber, iterations, true, true});
  fit.small = best.flare.ghosts;
  move_all(fit, best.centre_shift);
}

// Whether a ghost has left the window that it was fitted to, for something larger beside it.
bool has_left(const MeasuredGhost& ghost, const FoundGhost& found, double pixel) {
  const double s = 0.7 * found.last, reach = kWindowPart * found.radius + kWindow_px * pixel;
  const auto at = place_of(found, s), now = place_of(ghost, s);
  return !now || now->radius > reach || std::abs(now->centre - at->centre) > reach;
}

// Fits a ghost to what the others leave, and keeps it if the pictures become likelier by more than chance.
bool add_small_ghost(FlareFit& fit, const std::vector<FitStation>& residuals, const FoundGhost& found) {
  std::optional<MeasuredGhost> ghost = fitted_spot(fit, residuals, found);
  if (!ghost) return false;
  fit.small.push_back(std::move(*ghost));
  fit.small_found.push_back(found);
  return true;
}

// The cost of small ghosts, in windows about those of now, at the stations held out.
double held_small_cost(const FlareFit& fit, const std::vector<MeasuredGhost>& ghosts) {
  const std::vector<FitStation> windows =
      windows_about(residual_stations(fit.held_fine, fit.flare(), fit.context), fit.small);
  FlareProblem problem(windows, fit.flare_of(ghosts));
  problem.huber = fit.options.huber;
  problem.context = fit.context;
  return problem.cost(problem.layout.pack(problem.flare));
}

}  // namespace

std::optional<MeasuredGhost> fitted_spot(FlareFit& fit, const std::vector<FitStation>& residuals,
                                         const FoundGhost& found) {
  const std::vector<FitStation> windows = windows_about(residuals, std::vector{found});
  if (windows.empty()) return std::nullopt;
  const double before = FlareProblem(windows, fit.flare_of({})).cost(Eigen::VectorXd(0));
  LevelFit best{fit.flare_of({start_of_ghost(found, windows, fit.flare().s_max)}), before, 0.0};
  for (const double huber : {kFarHuber, fit.options.huber})
    best = optimised(fit, windows, best.flare, {huber, kAloneIterations, false, true});
  const auto unknowns = static_cast<double>(ParameterLayout(best.flare).size());
  if (fit.context.cancelled() || before - best.cost < kLeastGain * unknowns) return std::nullopt;
  if (has_left(best.flare.ghosts[0], found, 1.0 / windows.front().frame.pixels.focal_length_px)) return std::nullopt;
  return best.flare.ghosts[0];
}

void find_small_ghosts(FlareFit& fit, int most) {
  std::vector<FoundGhost> known = fit.small_found;
  int rejected = 0;
  const auto residuals_now = [&] {
    return residual_stations(residual_stations(fit.fine, fit.flare(), fit.context), fit.flare_of(fit.small),
                             fit.context);
  };
  std::vector<FitStation> residuals = residuals_now();
  while (static_cast<int>(fit.small.size()) < most && rejected < kMostRejected && !fit.context.cancelled()) {
    const std::vector<SearchPicture> pictures = search_pictures(residuals, usual_error(residuals));
    const auto found = strongest_spot(pictures, {6.0, fit.options.min_contrast}, known, fit.context);
    if (!found) break;
    known.push_back(*found);
    if (!add_small_ghost(fit, residuals, *found)) {
      ++rejected;
      continue;
    }
    rejected = 0;
    if (fit.small.size() % kWithNeighbours == 1) {
      fit_small_together(fit, kTogetherIterations);
      residuals = residuals_now();
    } else {
      residuals = residual_stations(std::move(residuals), fit.flare_of({fit.small.back()}), fit.context);
    }
  }
  if (fit.small.empty()) return;
  fit_small_together(fit, kTogetherIterations);
  subtract_small_ghosts(fit);
}

void finish_small_ghosts(FlareFit& fit) {
  if (fit.small.empty()) return;
  fit_small_together(fit, kTogetherIterations);
  if (!fit.held_fine.empty()) {
    const std::vector<FitStation> windows =
        windows_about(residual_stations(fit.fine, fit.flare(), fit.context), fit.small);
    double least = held_small_cost(fit, fit.small);
    for (int degree = 1; degree <= fit.options.max_degree && !fit.context.cancelled(); ++degree) {
      std::vector<MeasuredGhost> more = fit.small;
      for (MeasuredGhost& ghost : more) ghost = with_degree(ghost, degree);
      const LevelFit best =
          optimised(fit, windows, fit.flare_of(more), {fit.options.huber, kTogetherIterations, false, true});
      const double cost = held_small_cost(fit, best.flare.ghosts);
      if (!(cost < least)) break;
      least = cost;
      fit.small = best.flare.ghosts;
    }
  }
  subtract_small_ghosts(fit);
}

}  // namespace contrejour::inline internal
