// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/piece_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <queue>
#include <utility>

namespace contrejour::inline internal::area {
namespace {

constexpr std::array kAcross{1, 2, 3, 4, 6, 8, 12};
constexpr double kFasterThanAngle = 3.0;  // assumed relative change of a motion per unit of angle (tangent)
constexpr double kSquaresFraction = 0.003;  // of the allowed error: smaller errors of a ghost are not examined
constexpr double kFluxFraction = 5e-4;  // of all flux: smaller errors of a ghost are not examined
constexpr double kFluxAllowed = 0.004;  // of the flux of all ghosts
constexpr double kKnownFlux = 0.004;  // of a ghost's flux: accuracy of measurements by grids of rays
constexpr double kSpot_px = 40.0;  // radius
// How far outside its bound the least blocked ray may be, if other parts of the light may make the ghost: kOutside plus
// a light's radius, as a tangent, times kOutsideByAngle.
constexpr double kOutsideByAngle = 60.0, kOutside = 0.02;

double outline_px(const GhostBlur& ghost) {
  return std::numbers::pi * (ghost.blur_px.x + ghost.blur_px.y + ghost.size_px.x + ghost.size_px.y);
}

double edge_width_px(const GhostBlur& ghost) { return std::max(std::min(ghost.blur_px.x, ghost.size_px.x), 1e-3); }

double radius_of(const LightPiece& piece) { return radii_of(piece.covariance).y; }

// The fraction of the flux that a linear change of the pupil's area over the light loses.
double foreseen_flux(const GhostMotion& motion, const LightPiece& whole) {
  const double closing = 2.0 * std::sqrt(std::max(dot(motion.area_rate, whole.covariance(motion.area_rate)), 0.0));
  return std::min(0.125 * closing * closing, 1.0);
}

// The weight of a level: errors above the peak do not count.
double limited(double level) { return level / (1.0 + level); }

double moved_error(const GhostBlur& ghost, double displacement_px, double peak) {
  return outline_px(ghost) * misfit_error(ghost.level / peak, edge_width_px(ghost), displacement_px);
}

double dimmed_error(const GhostBlur& ghost, double flux_change, double peak) {
  const double off = flux_change * limited(ghost.level / peak);
  return off * off * ghost.area_px;
}

// How errors fall with the number of pieces across: as n^-3, measured as 9 dB for each doubling, and as n^-2 for the
// flux.
double left_of(double squares, int across) { return squares / (static_cast<double>(across) * across * across); }
double flux_left_of(double flux_error, int across) { return flux_error / (static_cast<double>(across) * across); }

}  // namespace

bool may_need_parts(const GhostOfArea& ghost, const LightPiece& whole, const AreaBudget& budget) {
  if (!ghost.motion.is_open)
    return ghost.motion.flux_mm2 > 0.0 && ghost.motion.outside < kOutside + kOutsideByAngle * radius_of(whole);
  if (!(ghost.blur.level > 0.0) || !(budget.peak > 0.0)) return false;
  const double flux_change = foreseen_flux(ghost.motion, whole);
  if (flux_change * ghost.blur.flux > kFluxFraction * budget.flux) return true;
  const double displacement_px = 0.5 * ghost.blur.blur_px.y * kFasterThanAngle * radius_of(whole);
  return moved_error(ghost.blur, displacement_px, budget.peak) + dimmed_error(ghost.blur, flux_change, budget.peak) >
         kSquaresFraction * budget.squares;
}

void foresee_errors(GhostOfArea& ghost, const LightPiece& whole, std::span<const LightPiece> parts,
                    const AreaBudget& budget) {
  const double peak = budget.peak;
  if (!(peak > 0.0)) return;
  ghost.squares = map_error(ghost.blur, ghost.blur.px, whole, peak);
  // A spot shows the light's outline, and pixels may be too coarse for its kernel; pieces would be drawn at their true
  // positions.
  const BlurredGhost blurred = ghost.blur.over(peak);
  if (blurred.size_px.y + blurred.blur_px.y < kSpot_px)
    ghost.squares += pixel_error(blurred, spot_level(blurred, 0, budget.spot_squares));
  if (ghost.part_blurs.empty()) return;
  double flux = 0.0, area_px = 0.0, level = 0.0, squares = 0.0, lit = 0.0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const GhostBlur& part = ghost.part_blurs[k];
    if (!ghost.part_motions[k].is_open) continue;
    flux += part.flux;
    level = std::max(level, part.level);
    area_px = std::max(area_px, part.area_px);
    if (!ghost.motion.is_open) continue;
    const Vec2 bent = (part.motion_px - ghost.blur.motion_px)(parts[k].middle) * 0.5;
    squares += part.flux * dot(bent, bent);
    lit += part.flux;
  }
  if (!ghost.motion.is_open) {
    const double off = limited(level / peak);
    ghost.squares = off * off * area_px;
    ghost.flux_error = flux;
    return;
  }
  const double whole_flux = ghost.blur.flux;
  const double off = std::max(std::abs(whole_flux - flux) - kKnownFlux * whole_flux, 0.0);
  if (ghost.blur.level > 0.0 || level > 0.0) ghost.flux_error = off;
  GhostBlur bright = ghost.blur;
  bright.level = std::max(bright.level, level);
  ghost.squares += dimmed_error(bright, std::min(off / std::max(whole_flux, 1e-30), 1.0), peak);
  if (lit > 0.0) ghost.squares += moved_error(bright, 2.0 * std::sqrt(squares / lit), peak);
  // An upper bound: all light is displaced.
  const double all = limited(bright.level / peak);
  ghost.squares = std::min(ghost.squares, 2.0 * all * all * bright.area_px);
}

int finer_than(int across) { return *std::ranges::upper_bound(kAcross, across); }

void choose_pieces(std::span<GhostOfArea> ghosts, const AreaBudget& budget) {
  using Gain = std::pair<double, std::size_t>;
  // The error that the next finer division saves for each additional piece.
  const auto refine = [&](double allowed, const auto& left) {
    const auto saved = [&](const GhostOfArea& ghost) {
      return left(ghost, ghost.across) - left(ghost, finer_than(ghost.across));
    };
    std::priority_queue<Gain> steps;
    double sum = 0.0;
    const auto push = [&](std::size_t k) {
      const int n = ghosts[k].across;
      if (n == kAcross.back()) {
        sum -= left(ghosts[k], n);  // other ghosts need not compensate for it
        return;
      }
      const int finer = finer_than(n);
      steps.emplace(saved(ghosts[k]) / (finer * finer - n * n), k);
    };
    for (const GhostOfArea& ghost : ghosts)
      sum += left(ghost, ghost.across) - (ghost.finer > 0.0 ? ghost.finer * saved(ghost) : 0.0);
    for (std::size_t k = 0; k < ghosts.size(); ++k) push(k);
    while (sum > allowed && !steps.empty() && steps.top().first > 0.0) {
      const std::size_t k = steps.top().second;
      GhostOfArea& ghost = ghosts[k];
      const double whole = saved(ghost), rest = (1.0 - ghost.finer) * whole;
      if (sum - rest < allowed) {
        ghost.finer += (sum - allowed) / whole;
        return;
      }
      steps.pop();
      sum -= rest;
      ghost.across = finer_than(ghost.across);
      ghost.finer = 0.0;
      push(k);
    }
  };
  refine(budget.squares, [](const GhostOfArea& ghost, int across) { return left_of(ghost.squares, across); });
  refine(kFluxAllowed * budget.flux,
         [](const GhostOfArea& ghost, int across) { return flux_left_of(ghost.flux_error, across); });
}

}  // namespace contrejour::inline internal::area
