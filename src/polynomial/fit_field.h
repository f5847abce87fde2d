// SPDX-License-Identifier: Apache-2.0
// Divides the field of one ghost into zones, and fits each.
#pragma once

#include <vector>

#include "polynomial/fit_zone.h"

namespace contrejour::inline internal::polynomial {

// From the axis to the largest field, over the nodes' scales: adjoining zones, each at every node.
[[nodiscard]] std::vector<std::vector<PolynomialZone>> fit_field(const ZoneProblem& problem, double largest);

[[nodiscard]] inline bool is_traced(const std::vector<PolynomialZone>& zone) {
  return zone.front().state == PolynomialZone::State::Traced;
}

}  // namespace contrejour::inline internal::polynomial
