// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/piece_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <vector>

namespace contrejour::inline internal::area {
namespace {

constexpr std::array kAcross{1, 2, 3, 4, 6, 8, 12};
constexpr double kFasterThanAngle = 3.0;  // assumed relative change of a motion per unit of angle (tangent)
// Smaller errors of a ghost are not examined, and those twice as large count in full:
constexpr double kSquaresFraction = 0.0015;  // of the allowed error
constexpr double kFluxFraction = 2.5e-4;  // of all flux
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

// How errors fall with the number of pieces across: as this power of it, measured as 9 dB for each doubling.
constexpr double kSquaresPower = 3.0, kFluxPower = 2.0;

}  // namespace

double doubt_about(const GhostOfArea& ghost, const LightPiece& whole, const AreaBudget& budget) {
  if (!ghost.motion.is_open) {
    const bool may_open =
        ghost.motion.flux_mm2 > 0.0 && ghost.motion.outside < kOutside + kOutsideByAngle * radius_of(whole);
    return may_open ? 1.0 : 0.0;
  }
  if (!(ghost.blur.level > 0.0) || !(budget.peak > 0.0)) return 0.0;
  const double flux_change = foreseen_flux(ghost.motion, whole);
  const double displacement_px = 0.5 * ghost.blur.blur_px.y * kFasterThanAngle * radius_of(whole);
  const double squares =
      moved_error(ghost.blur, displacement_px, budget.peak) + dimmed_error(ghost.blur, flux_change, budget.peak);
  const double times_flux = flux_change * ghost.blur.flux / (kFluxFraction * budget.flux),
               times_squares = squares / (kSquaresFraction * budget.squares);
  return std::clamp(std::max(times_flux, times_squares) - 1.0, 0.0, 1.0);
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
  if (ghost.blur.level > 0.0 || level > 0.0) ghost.flux_error = ghost.doubt * off;
  GhostBlur bright = ghost.blur;
  bright.level = std::max(bright.level, level);
  double by_parts = dimmed_error(bright, std::min(off / std::max(whole_flux, 1e-30), 1.0), peak);
  if (lit > 0.0) by_parts += moved_error(bright, 2.0 * std::sqrt(squares / lit), peak);
  ghost.squares += ghost.doubt * by_parts;
  // An upper bound: all light is displaced.
  const double all = limited(bright.level / peak);
  ghost.squares = std::min(ghost.squares, 2.0 * all * all * bright.area_px);
}

int finer_than(int across) { return *std::ranges::upper_bound(kAcross, across); }

namespace {

struct Division {
  int across = 1;
  double finer = 0.0;  // the part of the light that is drawn with the next finer one
};

// About so many pieces across.
Division division(double pieces) {
  constexpr double kHeld = 0.1;  // so near to a whole number only that one is drawn: a mixture takes more pieces
  if (pieces >= kAcross.back()) return {kAcross.back(), 0.0};
  const auto finer = std::ranges::upper_bound(kAcross, pieces);
  const int across = *std::prev(finer);
  const double part = (pieces - across) / (*finer - across);
  return {across, std::clamp((part - kHeld) / (1.0 - 2.0 * kHeld), 0.0, 1.0)};
}

// The fraction of the error that is left.
double left_by(const Division& made, double power) {
  const double here = std::pow(made.across, -power);
  return made.finer > 0.0 ? std::lerp(here, std::pow(finer_than(made.across), -power), made.finer) : here;
}

// Raises the numbers of pieces across of all ghosts until together they leave the error allowed, with one common gain
// for each piece. The numbers are real ones, because with whole ones the gain would jump: an error of one ghost that
// changes a little would change the divisions of all others.
void refine(std::span<double> across, std::span<const GhostOfArea> ghosts, double allowed, double power,
            double GhostOfArea::* error) {
  constexpr int kBisections = 50;
  constexpr double kRange = 1e-12;  // of the largest gain
  // From this number on, further pieces save less than this gain each.
  const auto worth = [&](std::size_t g, double least_gain) {
    const double pieces = std::pow(0.5 * power * ghosts[g].*error / least_gain, 1.0 / (power + 2.0));
    return std::clamp(pieces, across[g], static_cast<double>(kAcross.back()));
  };
  // What the finest division leaves does not count: other ghosts need not compensate for it.
  const double least = left_by({kAcross.back(), 0.0}, power);
  const auto left = [&](double least_gain) {
    double sum = 0.0;
    for (std::size_t g = 0; g < ghosts.size(); ++g)
      if (ghosts[g].*error > 0.0) sum += ghosts[g].*error * (left_by(division(worth(g, least_gain)), power) - least);
    return sum;
  };
  double largest = 0.0;
  for (const GhostOfArea& ghost : ghosts) largest = std::max(largest, 0.5 * power * ghost.*error);
  if (!(largest > 0.0) || left(largest) <= allowed) return;
  double few = largest, many = kRange * largest;
  for (int k = 0; k < kBisections; ++k) {
    const double middle = std::sqrt(few * many);
    (left(middle) > allowed ? few : many) = middle;
  }
  for (std::size_t g = 0; g < ghosts.size(); ++g) across[g] = worth(g, many);
}

}  // namespace

void choose_pieces(std::span<GhostOfArea> ghosts, const AreaBudget& budget) {
  std::vector<double> across(ghosts.size(), 1.0);
  refine(across, ghosts, budget.squares, kSquaresPower, &GhostOfArea::squares);
  refine(across, ghosts, kFluxAllowed * budget.flux, kFluxPower, &GhostOfArea::flux_error);
  for (std::size_t g = 0; g < ghosts.size(); ++g) {
    const Division made = division(across[g]);
    ghosts[g].across = made.across;
    ghosts[g].finer = made.finer;
  }
}

}  // namespace contrejour::inline internal::area
