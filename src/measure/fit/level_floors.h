// SPDX-License-Identifier: Apache-2.0
// The unknown levels of a flare whose outlines are given, and the solution of their linear equations for which no light
// falls below 0. A flare is drawn without light below 0, so a solution that had some would not be what is drawn.
// Thread-safety: pure functions.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "measure/fit/flare_problem.h"

namespace contrejour::inline internal {

inline constexpr std::size_t kBorder = 0, kInside = 1, kFirstTerm = 2;  // levels of a ghost

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

// The powers of s, over s_max, that a level's coefficients multiply.
[[nodiscard]] std::vector<double> angle_terms(const Level& level, double s);

// The mean weight of the rings of a ghost's profile; `first`: the level of its first term.
[[nodiscard]] double ring_weight(const Levels& levels, std::size_t first, const Eigen::MatrixXd& matrix);

// A sum of levels at a station that must not fall below 0: a level, or a profile on one ring in one direction.
struct Floor {
  std::vector<Eigen::Index> index;  // of unknowns, ascending
  std::vector<double> term;  // that each multiplies
  double weight = 0;  // with which the square of a value below 0 counts
};

// The floors of one channel, whose equations have this matrix.
[[nodiscard]] std::vector<Floor> floors_of(const Levels& levels, std::span<const FitStation> stations,
                                           const MeasuredFlare& flare, const Eigen::MatrixXd& matrix);

// The unknowns of least squares, given by the lower half of their matrix, for which no floor's value is below 0 by more
// than its weight allows. `held` are the floors that hold: a start, which may be empty, and the result.
[[nodiscard]] Eigen::VectorXd solution_above(const std::vector<Floor>& floors, const Eigen::MatrixXd& matrix,
                                             const Eigen::VectorXd& right, std::vector<bool>& held);

}  // namespace contrejour::inline internal
