// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/amplitudes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "base/tasks.h"
#include "measure/fit/level_floors.h"
#include "measure/model/flare_curves.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kRgb = 3;
constexpr double kProfileRidge = 1e-3;   // of a ring's weight
constexpr double kWidestProfile = 1.5;   // of the picture's diagonal: a half axis; wider ghosts are the veil

// The values of ProfileWeights in the order of their terms: equations have their lower half only.
constexpr std::array<std::size_t, 2 * kProfileHarmonics> kAscending{0, 3, 1, 4, 2, 5};
static_assert(kProfileHarmonics == 3);

bool has_room_for_profile(const MeasuredGhost& ghost, const TangentFrame& frame, const AmplitudeSettings& settings) {
  const double radius_px = ghost.half_height(0.0) * frame.focal_length_px;
  return settings.profile_coefficients > 0 && radius_px >= settings.least_radius_px &&
         radius_px < kWidestProfile * std::hypot(frame.width, frame.height);
}

// Rims and cores that go through a focus change terms without a direction. The others change less with the angle, and
// have fewer coefficients, which saves most of the time of the equations.
std::size_t coefficients_of(std::size_t term, const AmplitudeSettings& settings) {
  return profile_term(term).harmonic == 0
             ? settings.profile_coefficients
             : std::min(settings.profile_coefficients, settings.most_directed_coefficients);
}

Levels levels_of(const MeasuredFlare& flare, const TangentFrame& frame, const AmplitudeSettings& settings) {
  Levels levels;
  const auto add = [&](std::size_t ghost, std::size_t kind, Parity parity, std::size_t count) {
    levels.all.push_back({ghost, kind, parity, levels.unknowns, count});
    levels.unknowns += static_cast<Eigen::Index>(count);
  };
  for (std::size_t g = 0; g < flare.ghosts.size(); ++g) {
    const MeasuredGhost& ghost = flare.ghosts[g];
    levels.first_of_ghost.push_back(levels.all.size());
    add(g, kBorder, ghost.border[0].parity, ghost.border[0].coefficients.size());
    const bool profile = has_room_for_profile(ghost, frame, settings);
    add(g, kInside, ghost.inside[0].parity, profile ? 0 : ghost.inside[0].coefficients.size());
    for (std::size_t k = 0; k < kProfileTerms && profile; ++k)
      add(g, kFirstTerm + k, profile_parity(k), coefficients_of(k, settings));
  }
  levels.first_of_ghost.push_back(levels.all.size());
  return levels;
}

// The contribution of a level of 1 to a pixel.
struct Share {
  std::size_t level = 0;  // in Levels
  double value = 0;
};

// The shares of all ghosts at all pixels of a station.
std::vector<std::vector<Share>> shares_at_pixels(const MeasuredFlare& flare, const Levels& levels,
                                                 const FitStation& station) {
  std::vector<std::vector<Share>> at_pixel(station.rate.pixels.size() / kRgb);
  const double pixel = 1.0 / station.frame.pixels.focal_length_px, area = pixel * pixel;
  for (std::size_t g = 0; g < flare.ghosts.size(); ++g) {
    const auto at = ghost_at(flare.ghosts[g], station.s, flare.s_max);
    if (!at) continue;
    const double scale = area * at->presence;
    const std::size_t first = levels.first_of_ghost[g];
    const bool profile = levels.first_of_ghost[g + 1] - first > kFirstTerm;
    const auto add = [&](std::uint32_t index, const ShadeWeights& weights) {
      std::vector<Share>& shares = at_pixel[index];
      if (weights.border > 0.0) shares.push_back({first + kBorder, scale * weights.border});
      if (!(weights.inside > 0.0)) return;
      if (!profile) return shares.push_back({first + kInside, scale * weights.inside});
      const ProfileWeights terms = profile_weights(at->outline, point_of(station.frame, index));
      for (const std::size_t k : kAscending) {
        if (terms.value[k] != 0.0)
          shares.push_back({first + kFirstTerm + terms.term[k], scale * weights.inside * terms.value[k]});
      }
    };
    GhostAtAngle plain = *at;  // flat pixels are told apart, whatever the profile
    plain.has_profile = false;
    const GhostPixels pixels = ghost_pixels(plain, station.frame, false);
    for (const GhostPixel& one : pixels.near_border) add(one.index, one.weights);
    for (const std::uint32_t index : pixels.flat) add(index, {0.0, 1.0});
  }
  return at_pixel;
}

struct LinearEquations {
  explicit LinearEquations(Eigen::Index size)
      : matrix{Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Zero(size, size), Eigen::MatrixXd::Zero(size, size)},
        right(Eigen::MatrixXd::Zero(size, kRgb)) {}

  std::array<Eigen::MatrixXd, kRgb> matrix;  // of each channel: the lower half
  Eigen::MatrixXd right;  // a column for each channel
};

// A station's equations for the values of all levels, with weights that are robust about the flare as it is.
LinearEquations linear_equations_of(const MeasuredFlare& flare, const Levels& levels, const FitStation& station,
                                    double huber) {
  LinearEquations equations(static_cast<Eigen::Index>(levels.all.size()));
  const auto at_pixel = shares_at_pixels(flare, levels, station);
  const Image model = model_image(flare, station);
  for (std::size_t index = 0; index < at_pixel.size(); ++index) {
    const std::vector<Share>& shares = at_pixel[index];
    for (std::size_t c = 0; c < kRgb; ++c) {
      const std::size_t k = kRgb * index + c;
      const auto weight = static_cast<double>(station.weight.pixels[k]),
                 rate = static_cast<double>(station.rate.pixels[k]);
      if (weight == 0.0) continue;
      const double off = std::abs(static_cast<double>(model.pixels[k]) - rate) * std::sqrt(weight);
      const double robust = off > huber ? weight * huber / off : weight;
      for (std::size_t a = 0; a < shares.size(); ++a) {
        const auto row = static_cast<Eigen::Index>(shares[a].level);
        const double weighted = robust * shares[a].value;
        equations.right(row, static_cast<Eigen::Index>(c)) += weighted * rate;
        for (std::size_t b = 0; b <= a; ++b)
          equations.matrix[c](row, static_cast<Eigen::Index>(shares[b].level)) += weighted * shares[b].value;
      }
    }
  }
  return equations;
}

// From the values of levels at a station to their coefficients; s: over s_max. The lower half of the matrix.
void add_linear(const LinearEquations& station, const Levels& levels, double s, LinearEquations& sum) {
  std::vector<std::vector<double>> terms;
  for (const Level& level : levels.all) terms.push_back(angle_terms(level, s));
  for (std::size_t a = 0; a < levels.all.size(); ++a) {
    const auto row = static_cast<Eigen::Index>(a);
    for (std::size_t i = 0; i < terms[a].size(); ++i)
      sum.right.row(levels.all[a].first + static_cast<Eigen::Index>(i)) += terms[a][i] * station.right.row(row);
    for (std::size_t b = 0; b <= a; ++b) {
      for (std::size_t c = 0; c < kRgb; ++c) {
        const double value = station.matrix[c](row, static_cast<Eigen::Index>(b));
        if (value == 0.0) continue;
        for (std::size_t i = 0; i < terms[a].size(); ++i) {
          for (std::size_t j = 0; j < terms[b].size(); ++j) {
            sum.matrix[c](levels.all[a].first + static_cast<Eigen::Index>(i),
                          levels.all[b].first + static_cast<Eigen::Index>(j)) += value * terms[a][i] * terms[b][j];
          }
        }
      }
    }
  }
}

// Holds neighbouring rings to one another, and directions that differ to none.
void add_smoothness(const Levels& levels, const AmplitudeSettings& settings, Eigen::MatrixXd& matrix) {
  for (std::size_t g = 0; g + 1 < levels.first_of_ghost.size(); ++g) {
    const std::size_t first = levels.first_of_ghost[g] + kFirstTerm;
    if (levels.first_of_ghost[g + 1] <= first) continue;
    const double weight = ring_weight(levels, first, matrix);
    for (std::size_t k = 0; k < kProfileTerms; ++k) {
      const ProfileTerm term = profile_term(k);
      const bool has_inner = term.ring > (term.harmonic == 0 ? 0U : 1U);
      for (std::size_t i = 0; i < levels.all[first + k].count; ++i) {
        const Eigen::Index at = levels.all[first + k].first + static_cast<Eigen::Index>(i);
        matrix(at, at) += kProfileRidge * weight;
        if (term.harmonic == 0 && term.ring == 0) continue;
        matrix(at, at) += settings.smoothness * weight;
        if (!has_inner) continue;
        const Eigen::Index inner = levels.all[first + k - 1].first + static_cast<Eigen::Index>(i);
        matrix(inner, inner) += settings.smoothness * weight;
        matrix(at, inner) -= settings.smoothness * weight;
      }
    }
  }
}

AngleCurve curve_of(const Level& level, const Eigen::VectorXd& solution, double s_max) {
  AngleCurve curve{level.parity, std::vector<double>(level.count)};
  for (std::size_t k = 0; k < level.count; ++k) {
    curve.coefficients[k] =
        solution[level.first + static_cast<Eigen::Index>(k)] * std::pow(s_max, -power_of(level.parity, k));
  }
  return curve;
}

void set_levels(const Levels& levels, const Eigen::VectorXd& solution, std::size_t channel, MeasuredFlare& flare) {
  for (MeasuredGhost& ghost : flare.ghosts) ghost.profile[channel].clear();
  for (const Level& level : levels.all) {
    MeasuredGhost& ghost = flare.ghosts[level.ghost];
    AngleCurve curve = curve_of(level, solution, flare.s_max);
    if (level.kind == kBorder) {
      ghost.border[channel] = std::move(curve);
    } else if (level.kind == kInside) {
      ghost.inside[channel] = std::move(curve);
    } else {
      ghost.profile[channel].push_back(std::move(curve));
    }
  }
}

}  // namespace

MeasuredFlare with_best_amplitudes(std::span<const FitStation> stations, MeasuredFlare flare,
                                   const AmplitudeSettings& settings, const Context& context) {
  if (stations.empty() || flare.ghosts.empty()) return flare;
  const Levels levels = levels_of(flare, stations.front().frame.pixels, settings);
  std::array<std::vector<bool>, kRgb> held;
  for (int round = 0; round < settings.rounds; ++round) {
    LinearEquations sum(levels.unknowns);
    const bool done = ordered_pipeline(
        stations.size(), context,
        [&](std::size_t k) { return linear_equations_of(flare, levels, stations[k], settings.huber); },
        [&](std::size_t k, const LinearEquations& one) { add_linear(one, levels, stations[k].s / flare.s_max, sum); });
    if (!done) return flare;
    std::array<Eigen::VectorXd, kRgb> solutions;
    const bool solved = parallel_for(kRgb, context, [&](std::size_t c) {
      add_smoothness(levels, settings, sum.matrix[c]);
      solutions[c] = solution_above(floors_of(levels, stations, flare, sum.matrix[c]), sum.matrix[c],
                                    sum.right.col(static_cast<Eigen::Index>(c)), held[c]);
    });
    if (!solved) return flare;
    for (std::size_t c = 0; c < kRgb; ++c) set_levels(levels, solutions[c], c, flare);
  }
  return flare;
}

}  // namespace contrejour::inline internal
