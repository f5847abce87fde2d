// SPDX-License-Identifier: Apache-2.0
// Rates a choice of terms that all zones of a field share: each zone fits its own coefficients.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "contrejour/expert/published_fits.h"
#include "polynomial/published/term_tables.h"

namespace contrejour::inline internal::polynomial {

class ZoneErrors {
 public:
  ZoneErrors(std::span<const published::ZoneSamples> zones, int largest_exponent);

  [[nodiscard]] std::size_t zones() const { return tables_.size(); }
  // Root of the mean square of the zones' errors; infinite where terms depend on each other in a zone.
  [[nodiscard]] double error(std::span<const published::Exponents> terms) const;
  // One zone's coefficients and its error.
  struct Fitted {
    Eigen::VectorXd coefficients;
    double error = 0.0;
  };
  [[nodiscard]] Fitted fit(std::size_t zone, std::span<const published::Exponents> terms) const;

 private:
  std::vector<TermTables> tables_;
  std::vector<Eigen::VectorXd> values_;
};

}  // namespace contrejour::inline internal::polynomial
