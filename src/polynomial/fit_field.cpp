// SPDX-License-Identifier: Apache-2.0
#include "polynomial/fit_field.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal::polynomial {
namespace {

using Zones = std::vector<std::vector<PolynomialZone>>;

// The zones from one field to another: one, or the halves of its area if that serves a part of it.
Zones fit_zones(const ZoneProblem& problem, double low, double high, int halvings) {
  Zones whole{fit_zone(problem, low, high)};
  if (!is_traced(whole.front()) || halvings == 0) return whole;
  const double middle = std::sqrt(0.5 * (low * low + high * high));
  Zones parts = fit_zones(problem, low, middle, halvings - 1);
  for (auto& zone : fit_zones(problem, middle, high, halvings - 1)) parts.push_back(std::move(zone));
  return std::ranges::all_of(parts, is_traced) ? whole : parts;
}

// At any node, or at any state between them.
bool has_light_at(const ZoneProblem& problem, double field) {
  const bool at_node = std::ranges::any_of(
      problem.nodes, [&](const FitState& node) { return has_light(node.rays->bounds(field * node.field_scale)); });
  if (at_node || problem.nodes.size() == 1) return at_node;
  return std::ranges::any_of(problem.tests, [&](const TestState& test) {
    double scale = 0.0;
    for (std::size_t n = 0; n < problem.nodes.size(); ++n) scale += test.weights[n] * problem.nodes[n].field_scale;
    return has_light(test.rays->bounds(field * scale));
  });
}

}  // namespace

// The part of the field with light, as it shows at some fields: a part without is a zone of its own, since a fit of few
// fields with light has few rays.
Zones fit_field(const ZoneProblem& problem, double largest) {
  constexpr int kSteps = 24;
  constexpr double kWorthDividing = 0.85;  // of the field's area
  const auto field_at = [&](int step) { return largest * std::sqrt(static_cast<double>(step) / kSteps); };
  int first = kSteps, last = 0;
  for (int step = 0; step <= kSteps; ++step) {
    if (!has_light_at(problem, field_at(step))) continue;
    first = std::min(first, std::max(step - 1, 0));
    last = std::min(step + 1, kSteps);
  }
  const int halvings = problem.options.max_halvings;
  if (last <= first || last - first > kWorthDividing * kSteps) return fit_zones(problem, 0.0, largest, halvings);
  Zones zones;
  const auto add_dark = [&](int from, int to) {
    if (from == to) return;
    auto& zone = zones.emplace_back(problem.nodes.size());
    for (std::size_t n = 0; n < zone.size(); ++n) {
      zone[n].field_low = field_at(from) * problem.nodes[n].field_scale;
      zone[n].field_high = field_at(to) * problem.nodes[n].field_scale;
    }
  };
  add_dark(0, first);
  for (auto& zone : fit_zones(problem, field_at(first), field_at(last), halvings)) zones.push_back(std::move(zone));
  add_dark(last, kSteps);
  return zones;
}

}  // namespace contrejour::inline internal::polynomial
