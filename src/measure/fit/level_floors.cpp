// SPDX-License-Identifier: Apache-2.0
#include "measure/fit/level_floors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

#include "base/scalar.h"
#include "measure/model/flare_curves.h"

namespace contrejour::inline internal {
namespace {

constexpr double kRidge = 1e-6;         // of the diagonal: keeps what no pixel shows at 0
constexpr int kHoldingRounds = 12;      // Newton's steps
constexpr double kHeld = 10.0;          // of a level's weight at a station: how firmly it is held
constexpr std::size_t kDirections = 7;  // from 0 to pi, in which a profile's rings are held

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

double value_of(const Floor& floor, const Eigen::VectorXd& solution) {
  double value = 0.0;
  for (std::size_t i = 0; i < floor.index.size(); ++i) value += floor.term[i] * solution[floor.index[i]];
  return value;
}

// To the lower half.
void add_floor(const Floor& floor, Eigen::MatrixXd& matrix) {
  for (std::size_t i = 0; i < floor.index.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j)
      matrix(floor.index[i], floor.index[j]) += floor.weight * floor.term[i] * floor.term[j];
  }
}

void add_level(const Level& level, double factor, double s, Floor& floor) {
  const std::vector<double> terms = angle_terms(level, s);
  for (std::size_t k = 0; k < terms.size(); ++k) {
    floor.index.push_back(level.first + static_cast<Eigen::Index>(k));
    floor.term.push_back(factor * terms[k]);
  }
}

// The floors of a ghost's profile at an angle. Those on its rings suffice, since it is straight between them.
void add_profile(const Levels& levels, std::size_t first, double s, double weight, std::vector<Floor>& floors) {
  for (std::size_t ring = 0; ring < kProfileRings; ++ring) {
    const std::size_t directions = ring == 0 ? 1 : kDirections, harmonics = ring == 0 ? 1 : kProfileHarmonics;
    for (std::size_t d = 0; d < directions; ++d) {
      const double phi = kPi * static_cast<double>(d) / (kDirections - 1);
      Floor floor;
      floor.weight = weight / static_cast<double>(directions);
      for (std::size_t m = 0; m < harmonics; ++m)
        add_level(levels.all[first + profile_index({m, ring})], std::cos(static_cast<double>(m) * phi), s, floor);
      floors.push_back(std::move(floor));
    }
  }
}

}  // namespace

std::vector<double> angle_terms(const Level& level, double s) {
  std::vector<double> terms(level.count);
  for (std::size_t k = 0; k < level.count; ++k) terms[k] = std::pow(s, power_of(level.parity, k));
  return terms;
}

double ring_weight(const Levels& levels, std::size_t first, const Eigen::MatrixXd& matrix) {
  double weight = 0.0;
  for (std::size_t k = 0; k < kProfileRings; ++k)
    weight += matrix(levels.all[first + k].first, levels.all[first + k].first) / kProfileRings;
  return weight;
}

std::vector<Floor> floors_of(const Levels& levels, std::span<const FitStation> stations, const MeasuredFlare& flare,
                             const Eigen::MatrixXd& matrix) {
  std::vector<Floor> floors;
  const double each = kHeld / static_cast<double>(stations.size());
  for (std::size_t g = 0; g < flare.ghosts.size(); ++g) {
    const std::size_t first = levels.first_of_ghost[g], term = first + kFirstTerm;
    const bool profile = levels.first_of_ghost[g + 1] > term;
    const double weight = profile ? each * ring_weight(levels, term, matrix) : 0.0;
    for (const FitStation& station : stations) {
      if (station.s > flare.ghosts[g].last) continue;
      const double s = station.s / flare.s_max;
      for (const Level& level : {levels.all[first + kBorder], levels.all[first + kInside]}) {
        if (level.count == 0) continue;
        floors.push_back({{}, {}, each * matrix(level.first, level.first)});
        add_level(level, 1.0, s, floors.back());
      }
      if (profile) add_profile(levels, term, s, weight, floors);
    }
  }
  return floors;
}

// Newton's steps for the squares with those of all values below 0 in addition, which are convex.
Eigen::VectorXd solution_above(const std::vector<Floor>& floors, const Eigen::MatrixXd& matrix,
                               const Eigen::VectorXd& right, std::vector<bool>& held) {
  held.resize(floors.size(), false);
  Eigen::VectorXd solution;
  for (int round = 0; round <= kHoldingRounds; ++round) {
    Eigen::MatrixXd with_floors = matrix;
    for (std::size_t k = 0; k < floors.size(); ++k)
      if (held[k]) add_floor(floors[k], with_floors);
    solution = Factors(with_floors).solve(right);
    bool changed = false;
    for (std::size_t k = 0; k < floors.size(); ++k) {
      const bool is_below = value_of(floors[k], solution) < 0.0;
      changed = changed || is_below != held[k];
      held[k] = is_below;
    }
    if (!changed) break;
  }
  return solution;
}

}  // namespace contrejour::inline internal
