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

// The error of the light's rim if it is divided: the shape of a piece is not drawn, so that the rim is as soft as a
// piece is wide. It shows where a ghost is smaller than the image of the light. For a spot, 0.25 of a piece's radius
// makes the error of a sum of soft pieces in place of a disc, to a tenth, for 2 to 12 pieces across.
double rim_error(const GhostBlur& ghost, int across, double peak) {
  constexpr double kDisplaced = 0.25;  // of the blur's radius over the pieces across
  constexpr double kSharp_px = 0.3;
  if (across == 1 || !(ghost.level > 0.0)) return 0.0;
  const Vec2 blur = ghost.blur_px, size = ghost.size_px;
  const double spot = dot(blur, blur) / (dot(blur, blur) + dot(size, size)),
               length_px = ghost.visible * std::numbers::pi * (blur.x + blur.y);
  return spot * length_px * misfit_error(ghost.level / peak, std::max(size.x, kSharp_px), kDisplaced * blur.x / across);
}

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

namespace {

using Parts = std::array<double, kAcross.size()>;

double pieces_at(std::size_t place) { return static_cast<double>(kAcross[place]) * kAcross[place]; }

// The error that a division of a ghost's light leaves: as it counts in the sum of all errors, and as divisions of the
// ghost are compared. They differ by the rim, for which other ghosts need not be divided more finely.
struct ErrorLeft {
  double counted = 0.0, compared = 0.0;
};

// A ghost's divisions, one for each of kAcross, and what each step to the next one saves for each further piece.
struct Divisions {
  Parts counted{};
  Parts left{};  // compared: the least that this division or a coarser one leaves
  std::array<double, kAcross.size() - 1> gain{};
  Parts reached{};  // the part of the ghost's light that is divided at least as finely, before
  // The part of the light that is divided if all steps are made. It is less than 1 if they save little together: a
  // ghost would otherwise pass from no division to the finest one as soon as that saves anything.
  double worth = 1.0;

  // Sets all but `reached`, from the errors that each division leaves. A step may save less than those after it, or
  // make the error larger: several steps then count as one, and no light is drawn with the divisions between. Gains
  // never rise.
  void set(const std::array<ErrorLeft, kAcross.size()>& errors) {
    constexpr double kWorthwhile = 0.67;  // of the error, saved by all steps
    for (std::size_t k = 0; k < left.size(); ++k)
      left[k] = k > 0 ? std::min(errors[k].compared, left[k - 1]) : errors[k].compared;
    // An error that no division saves does not count: other ghosts need not compensate for it.
    for (std::size_t k = 0; k < left.size(); ++k) counted[k] = std::min(errors[k].counted, left[k] - left.back());
    if (left.front() > 0.0) worth = std::min((1.0 - left.back() / left.front()) / kWorthwhile, 1.0);
    for (std::size_t from = 0; from < gain.size();) {
      const auto gain_to = [&](std::size_t to) { return (left[from] - left[to]) / (pieces_at(to) - pieces_at(from)); };
      std::size_t best = from + 1;
      for (std::size_t to = from + 2; to < left.size(); ++to)
        if (gain_to(to) > gain_to(best)) best = to;
      std::fill(gain.begin() + from, gain.begin() + best, gain_to(best));
      from = best;
    }
  }

  // The part of the light that is divided at least as finely as each of kAcross, if steps are worth making from this
  // gain on. A step is made in part over a range of gains, so that no ghost's division depends on the others' order.
  // The range reaches about to the next step, so that mostly two divisions are drawn: between steps a small change of
  // all errors would change the least gain, and the other divisions, by far.
  [[nodiscard]] Parts at(double least_gain) const {
    constexpr double kWholeStep = 6.0;  // times the least gain
    Parts parts{1.0};
    for (std::size_t k = 0; k < gain.size(); ++k) {
      const double step = std::clamp(std::log(gain[k] / least_gain) / std::log(kWholeStep), 0.0, 1.0);
      parts[k + 1] = std::max(worth * step, reached[k + 1]);
    }
    return parts;
  }
  // The error that counts there.
  [[nodiscard]] double error(const Parts& at_least) const {
    double sum = worth * counted.front();
    for (std::size_t k = 0; k < gain.size(); ++k) sum -= at_least[k + 1] * (counted[k] - counted[k + 1]);
    return sum;
  }
};

// Sets the divisions that together leave the error allowed: those above one common gain for each piece. reached: by
// ghost, the part of its light that is divided at least as finely as each of kAcross.
template <class Left>
void refine(std::span<const GhostOfArea> ghosts, double allowed, const Left& left, std::vector<Parts>& reached) {
  constexpr int kBisections = 50;
  constexpr double kRange = 1e-12;  // of the largest gain
  std::vector<Divisions> divisions(ghosts.size());
  double largest = 0.0;
  for (std::size_t g = 0; g < ghosts.size(); ++g) {
    Divisions& one = divisions[g];
    one.reached = reached[g];
    std::array<ErrorLeft, kAcross.size()> errors;
    for (std::size_t k = 0; k < kAcross.size(); ++k) errors[k] = left(ghosts[g], kAcross[k]);
    one.set(errors);
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
  for (std::size_t g = 0; g < ghosts.size(); ++g) reached[g] = divisions[g].at(many);
}

}  // namespace

void choose_pieces(std::span<GhostOfArea> ghosts, const AreaBudget& budget) {
  std::vector<Parts> reached(ghosts.size(), Parts{1.0});
  const auto squares_left = [&](const GhostOfArea& ghost, int across) {
    const double squares = left_of(ghost.squares, across);
    return ErrorLeft{squares, squares + rim_error(ghost.blur, across, budget.peak)};
  };
  const auto flux_left = [](const GhostOfArea& ghost, int across) {
    const double flux = flux_left_of(ghost.flux_error, across);
    return ErrorLeft{flux, flux};
  };
  refine(ghosts, budget.squares, squares_left, reached);
  refine(ghosts, kFluxAllowed * budget.flux, flux_left, reached);
  for (std::size_t g = 0; g < ghosts.size(); ++g) {
    Parts& parts = ghosts[g].parts = reached[g];
    for (std::size_t k = 0; k + 1 < parts.size(); ++k) parts[k] -= parts[k + 1];
  }
}

}  // namespace contrejour::inline internal::area
