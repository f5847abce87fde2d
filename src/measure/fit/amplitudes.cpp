// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/amplitudes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "base/tasks.h"
#include "measure/model/flare_curves.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kRgb = 3;
constexpr std::size_t kBorder = 0, kInside = 1, kFirstTerm = 2;  // levels of a ghost
constexpr double kRidge = 1e-6;          // of the diagonal: keeps what no pixel shows at 0
constexpr double kProfileRidge = 1e-3;   // of a ring's weight
constexpr int kHoldingRounds = 6;        // in which levels that fall below 0 are held there
constexpr double kHeld = 10.0;           // of a level's weight at a station: how firmly
constexpr double kWidestProfile = 1.5;   // of the picture's diagonal: a half axis; wider ghosts are the veil
constexpr double kBelow = 1e-3;          // of a level's largest value: it may fall so far below 0

// The values of ProfileWeights in the order of their terms: equations have their lower half only.
constexpr std::array<std::size_t, 2 * kProfileHarmonics> kAscending{0, 3, 1, 4, 2, 5};
static_assert(kProfileHarmonics == 3);

// A level of a ghost over the angle: its coefficients are unknowns from `first` on.
struct Level {
  std::size_t ghost = 0, kind = 0;
  Parity parity = Parity::Even;
  Eigen::Index first = 0;
  std::size_t count = 0;
};

struct Levels {
  std::vector<Level> all;
  std::vector<std::size_t> first_of_ghost;  // in `all`; one more at the end
  Eigen::Index unknowns = 0;
};

bool has_room_for_profile(const MeasuredGhost& ghost, const TangentFrame& frame, const AmplitudeSettings& settings) {
  const double radius_px = ghost.half_height(0.0) * frame.focal_length_px;
  return settings.profile_coefficients > 0 && radius_px >= settings.least_radius_px &&
         radius_px < kWidestProfile * std::hypot(frame.width, frame.height);
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
      add(g, kFirstTerm + k, profile_parity(k), settings.profile_coefficients);
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

std::vector<double> angle_terms(const Level& level, double s) {
  std::vector<double> terms(level.count);
  for (std::size_t k = 0; k < level.count; ++k) terms[k] = std::pow(s, power_of(level.parity, k));
  return terms;
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
    double weight = 0.0;
    for (std::size_t k = 0; k < kProfileRings; ++k)
      weight += matrix(levels.all[first + k].first, levels.all[first + k].first) / kProfileRings;
    for (std::size_t k = 0; k < kProfileTerms; ++k) {
      const ProfileTerm term = profile_term(k);
      const bool has_inner = term.ring > (term.harmonic == 0 ? 0U : 1U);
      for (std::size_t i = 0; i < settings.profile_coefficients; ++i) {
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

// Factors of a symmetric matrix, given by its lower half, with a ridge on its diagonal.
class Factors {
 public:
  explicit Factors(const Eigen::MatrixXd& matrix)
      : scale_(matrix.diagonal().unaryExpr([](double d) { return d > 0.0 ? 1.0 / std::sqrt(d) : 0.0; })) {
    Eigen::MatrixXd scaled = scale_.asDiagonal() * matrix * scale_.asDiagonal();
    scaled.diagonal().array() = 1.0 + kRidge;
    fast_.compute(scaled);  // in blocks; LDLT, which is not, for what the ridge leaves indefinite
    if (fast_.info() != Eigen::Success) sure_.compute(scaled.selfadjointView<Eigen::Lower>());
  }
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const {
    const Eigen::MatrixXd scaled = scale_.asDiagonal() * right;
    if (fast_.info() == Eigen::Success) return scale_.asDiagonal() * fast_.solve(scaled);
    return scale_.asDiagonal() * sure_.solve(scaled);
  }

 private:
  Eigen::VectorXd scale_;
  Eigen::LLT<Eigen::MatrixXd> fast_;
  Eigen::LDLT<Eigen::MatrixXd> sure_;
};

AngleCurve curve_of(const Level& level, const Eigen::VectorXd& solution, double s_max) {
  AngleCurve curve{level.parity, std::vector<double>(level.count)};
  for (std::size_t k = 0; k < level.count; ++k) {
    curve.coefficients[k] =
        solution[level.first + static_cast<Eigen::Index>(k)] * std::pow(s_max, -power_of(level.parity, k));
  }
  return curve;
}

// Adds to the equations that a level is 0 at the stations where it is below. False if it is so nowhere.
bool hold_at_zero(const Level& level, const Eigen::VectorXd& solution, std::span<const FitStation> stations,
                  const MeasuredFlare& flare, Eigen::MatrixXd& matrix) {
  const AngleCurve curve = curve_of(level, solution, flare.s_max);
  double most = 0.0;
  for (const FitStation& station : stations) most = std::max(most, std::abs(curve(station.s)));
  const double weight = kHeld * matrix(level.first, level.first) / static_cast<double>(stations.size());
  bool any = false;
  for (const FitStation& station : stations) {
    if (station.s > flare.ghosts[level.ghost].last || !(curve(station.s) < -kBelow * most)) continue;
    any = true;
    const std::vector<double> terms = angle_terms(level, station.s / flare.s_max);
    for (std::size_t i = 0; i < terms.size(); ++i) {
      for (std::size_t j = 0; j < terms.size(); ++j)
        matrix(level.first + static_cast<Eigen::Index>(i), level.first + static_cast<Eigen::Index>(j)) +=
            weight * terms[i] * terms[j];
    }
  }
  return any;
}

// The unknowns of levels that must not fall below 0, and those of profiles' terms.
struct Split {
  std::vector<Eigen::Index> levels, terms;
};

Split split_of(const Levels& levels) {
  Split split;
  for (const Level& level : levels.all)
    for (std::size_t i = 0; i < level.count; ++i)
      (level.kind < kFirstTerm ? split.levels : split.terms).push_back(level.first + static_cast<Eigen::Index>(i));
  return split;
}

// The coefficients of one channel for which no border or inside falls below 0. Terms of profiles, which are most of the
// unknowns, are eliminated once; the equations that hold levels at 0 do not contain them.
Eigen::VectorXd non_negative(Eigen::MatrixXd matrix, const Eigen::VectorXd& right, const Levels& levels,
                             std::span<const FitStation> stations, const MeasuredFlare& flare) {
  matrix.triangularView<Eigen::StrictlyUpper>() = matrix.transpose();
  const Split split = split_of(levels);
  const Factors terms(matrix(split.terms, split.terms));
  const Eigen::MatrixXd from_levels = terms.solve(matrix(split.terms, split.levels));
  const Eigen::VectorXd alone = terms.solve(right(split.terms));
  const Eigen::MatrixXd eliminated = matrix(split.levels, split.terms) * from_levels;
  const Eigen::VectorXd reduced_right = right(split.levels) - matrix(split.levels, split.terms) * alone;
  Eigen::VectorXd solution(levels.unknowns);
  for (int round = 0;; ++round) {
    const Eigen::MatrixXd held = matrix(split.levels, split.levels);
    Eigen::MatrixXd reduced = held - eliminated;
    reduced.diagonal() += kRidge * held.diagonal();
    solution(split.levels) = Factors(reduced).solve(reduced_right);
    solution(split.terms) = alone - from_levels * solution(split.levels);
    bool any = false;
    for (const Level& level : levels.all) {
      if (round < kHoldingRounds && level.kind < kFirstTerm && level.count > 0)
        any = hold_at_zero(level, solution, stations, flare, matrix) || any;
    }
    if (!any) return solution;
  }
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
      solutions[c] =
          non_negative(std::move(sum.matrix[c]), sum.right.col(static_cast<Eigen::Index>(c)), levels, stations, flare);
    });
    if (!solved) return flare;
    for (std::size_t c = 0; c < kRgb; ++c) set_levels(levels, solutions[c], c, flare);
  }
  return flare;
}

}  // namespace contrejour::inline internal
