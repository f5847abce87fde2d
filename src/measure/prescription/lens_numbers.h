// SPDX-License-Identifier: Apache-2.0
// The numbers of a lens that pictures may tell: from a prescription and their values to the lens.
// Thread-safety: pure functions.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "contrejour/expert/learn_lens.h"

namespace contrejour::inline internal {

// The numbers that have a tolerance, with values of 0.
[[nodiscard]] std::vector<LearntNumber> numbers_of(const Prescription& lens, const LensTolerances& tolerances);

// A change of the number for derivatives by differences.
[[nodiscard]] double difference_step(const LearntNumber& number);

struct AdjustableLens {
  Prescription lens;
  LensSettings settings;
  LensState nominal;
  std::vector<LearntNumber> numbers;
  double sensor_distance_mm = 0;  // from the last vertex, for distant objects

  // The prescription with these changes; the stop's radius is not among them.
  [[nodiscard]] Prescription prescription(const Eigen::VectorXd& values) const;
  // The configured lens with all changes. The stop keeps its size when gaps change.
  [[nodiscard]] Result<LensState> state(const Eigen::VectorXd& values) const;
};

[[nodiscard]] Result<AdjustableLens> adjustable_lens(const Prescription& lens, const LensSettings& settings,
                                                     const LensTolerances& tolerances);

}  // namespace contrejour::inline internal
