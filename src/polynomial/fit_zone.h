// SPDX-License-Identifier: Apache-2.0
// Fits one ghost's polynomials over a zone of the field, at one state of a lens or at the nodes of a range of states.
#pragma once

#include <vector>

#include "polynomial/zone_rays.h"

namespace contrejour::inline internal::polynomial {

// A state of the lens.
struct FitState {
  const GhostRays* rays = nullptr;
  double field_scale = 1.0;  // tangents over a zone's numbers
};

// A state at which a fit is tested by rays left out, and the weights of the nodes there.
struct TestState {
  const GhostRays* rays = nullptr;
  std::vector<double> weights;
};

struct ZoneProblem {
  const LensPolynomials& lens;  // without ghosts
  const PolynomialOptions& options;
  std::vector<FitState> nodes;
  std::vector<TestState> tests;  // one node: the node itself; else states between nodes
  Vec2 sensor_half_mm;
};

inline constexpr double kFractionOfEdge = 0.3, kFractionOfTransmittance = 0.25;  // targets, of the tolerances
inline constexpr double kNegligible = 0.5;  // of a target: wavelength terms that are left out
// True if higher degrees cannot be expected to bring an error down to the accepted one, even if each of them lowers it
// by twice as much as the last one did.
[[nodiscard]] bool is_hopeless(double p95, double before, int degrees_left, double accepted);

// low, high: of the field, over the nodes' scales. The zone at each node: all have the same state, orders and rims.
// Zones that do not reach the accuracy at all tests are Traced, without polynomials.
[[nodiscard]] std::vector<PolynomialZone> fit_zone(const ZoneProblem& problem, double low, double high);

}  // namespace contrejour::inline internal::polynomial
