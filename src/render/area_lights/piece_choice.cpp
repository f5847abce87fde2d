// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/piece_choice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
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

// A ghost's divisions: the error that each of kAcross leaves, and what the next finer one saves for each further piece.
struct Divisions {
  std::array<double, kAcross.size()> left{};
  std::array<double, kAcross.size() - 1> gain{};
  double from = 0.0;  // a place among kAcross, and the part of the next one: no coarser ones are chosen

  // The place at which the ghost is divided if steps are worth making from this gain on. A step is made in part over
  // a range of gains, so that no ghost's division depends on the others' order. The range nearly reaches to the next
  // step: between steps a small change of all errors would change the least gain, and the other divisions, by far.
  [[nodiscard]] double at(double least_gain) const {
    constexpr double kWholeStep = 8.0;  // times the least gain
    double place = 0.0;
    for (const double one : gain) place += std::clamp(std::log(one / least_gain) / std::log(kWholeStep), 0.0, 1.0);
    return std::max(place, from);
  }
  // The error there. What the finest division leaves does not count: other ghosts need not compensate for it.
  [[nodiscard]] double error(double place) const {
    const std::size_t k = std::min(static_cast<std::size_t>(place), gain.size() - 1);
    return std::lerp(left[k], left[k + 1], place - static_cast<double>(k)) - left.back();
  }
};

// Sets the divisions that together leave the error allowed: those above one common gain for each piece.
template <class Left>
void refine(std::span<GhostOfArea> ghosts, double allowed, const Left& left) {
  constexpr int kBisections = 50;
  constexpr double kRange = 1e-12;  // of the largest gain
  std::vector<Divisions> divisions(ghosts.size());
  double largest = 0.0;
  for (std::size_t g = 0; g < ghosts.size(); ++g) {
    Divisions& one = divisions[g];
    one.from = static_cast<double>(std::ranges::find(kAcross, ghosts[g].across) - kAcross.begin()) + ghosts[g].finer;
    for (std::size_t k = 0; k < kAcross.size(); ++k) one.left[k] = left(ghosts[g], kAcross[k]);
    for (std::size_t k = 0; k < one.gain.size(); ++k)
      one.gain[k] = (one.left[k] - one.left[k + 1]) / (kAcross[k + 1] * kAcross[k + 1] - kAcross[k] * kAcross[k]);
    largest = std::max(largest, one.gain.front());
  }
  const auto error = [&](double least_gain) {
    double sum = 0.0;
    for (const Divisions& one : divisions) sum += one.error(one.at(least_gain));
    return sum;
  };
  if (!(largest > 0.0) || error(largest) <= allowed) return;
  double few = largest, many = kRange * largest;
  for (int k = 0; k < kBisections; ++k) {
    const double middle = std::sqrt(few * many);
    (error(middle) > allowed ? few : many) = middle;
  }
  for (std::size_t g = 0; g < ghosts.size(); ++g) {
    const double place = divisions[g].at(many);
    const std::size_t k = std::min(static_cast<std::size_t>(place), kAcross.size() - 1);
    ghosts[g].across = kAcross[k];
    ghosts[g].finer = place - static_cast<double>(k);
  }
}

}  // namespace

void choose_pieces(std::span<GhostOfArea> ghosts, const AreaBudget& budget) {
  refine(ghosts, budget.squares, [](const GhostOfArea& ghost, int across) { return left_of(ghost.squares, across); });
  refine(ghosts, kFluxAllowed * budget.flux,
         [](const GhostOfArea& ghost, int across) { return flux_left_of(ghost.flux_error, across); });
}

}  // namespace contrejour::inline internal::area
