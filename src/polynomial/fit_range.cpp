// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <optional>
#include <span>

#include <fmt/format.h>

#include "base/tasks.h"
#include "contrejour/expert/check_lens.h"
#include "contrejour/expert/polynomial_range.h"
#include "polynomial/fit_field.h"
#include "polynomial/fit_lens.h"
#include "polynomial/range_states.h"
#include "polynomial/zone_nodes.h"

namespace contrejour::inline internal::polynomial {
namespace {

// Focus moves the sensor alone, by nearly the inverse of the distance.
constexpr int kZoomNodes = 5, kFocusNodes = 4;
constexpr int kPositionNodes = 17;
constexpr int kMaxDivisions = 4;
constexpr int kMaxFieldHalvings = 1;  // of parts of the range, of which there are many
constexpr double kPositionTolerance_mm = 1e-4;
constexpr double kRounding = 1e-9;  // of coordinates, relative to a part of the range

double between(double low, double high, double coordinate) {
  return 0.5 * (low + high) + 0.5 * (high - low) * coordinate;
}

// The coordinate in [-1, 1] within a part of the range.
double within(double low, double high, double at) { return (2.0 * at - low - high) / (high - low); }

// A lens without its positions, so that its fingerprint is that of its shapes, glasses and coatings.
LensState without_positions(LensState lens) {
  for (SurfaceState& surface : lens.surfaces) surface.z_mm = 0.0;
  lens.sensor_z_mm = 0.0;
  return lens;
}

class GhostRangeFit {
 public:
  GhostRangeFit(const LensPolynomials& common, const PolynomialRangeOptions& options, RangeStates& states,
                const Ghost& ghost)
      : common_(common), options_(options), states_(states), ghost_(ghost) {}

  GhostRange run() {
    GhostRange fitted{ghost_, {}};
    const std::vector<double>& breaks = states_.breaks();
    for (std::size_t k = 0; k + 1 < breaks.size(); ++k)
      for (PolynomialSpan& span : fit_spans(breaks[k], breaks[k + 1], options_.max_divisions))
        fitted.spans.push_back(std::move(span));
    return fitted;
  }

 private:
  // The rays of states that a fit needs live as long as it is made.
  struct Problem {
    std::deque<GhostRays> rays;
    std::vector<FitState> nodes;
    std::vector<TestState> tests;
  };

  [[nodiscard]] bool add(Problem& problem, double coordinate, double& field_scale) {
    const RangeState* const state = states_.at(coordinate);
    if (state == nullptr || !is_fitted(state->lens, ghost_)) return false;
    problem.rays.emplace_back(state->lens, state->steps, ghost_, common_.entrance_z_mm);
    field_scale = state->largest_field;
    return true;
  }

  [[nodiscard]] bool has_states(Problem& problem, double low, double high) {
    const int count = options_.variable == PolynomialVariable::Zoom ? kZoomNodes : kFocusNodes;
    for (int n = 0; n < count; ++n) {
      // The ends exactly: states of zoom positions are known by them.
      const double at = n == 0 ? high : n == count - 1 ? low : between(low, high, node_coordinate(n, count));
      FitState node;
      if (!add(problem, at, node.field_scale)) return false;
      node.rays = &problem.rays.back();
      problem.nodes.push_back(node);
    }
    for (int n = 0; n + 1 < count; ++n) {
      const double coordinate = std::cos(std::numbers::pi * (n + 0.5) / (count - 1));
      double unused = 0.0;
      if (!add(problem, between(low, high, coordinate), unused)) return false;
      problem.tests.push_back({&problem.rays.back(), node_weights(count, coordinate)});
    }
    return true;
  }

  // The whole field at both ends, to be traced.
  PolynomialSpan traced(double low, double high) {
    PolynomialZone zone;
    zone.state = PolynomialZone::State::Traced;
    PolynomialSpan span{low, high, {{}}};
    for (const double end : {high, low}) {
      const RangeState* const state = states_.at(end);
      zone.field_high = state != nullptr ? state->largest_field : common_.max_field;
      span.zones.front().push_back(zone);
    }
    return span;
  }

  // One part, or its halves if that serves a part of it. The field is halved only where the range is not divided any
  // more, since halves of the range have fewer rays that fail at any node.
  std::vector<PolynomialSpan> fit_spans(double low, double high, int divisions) {
    Problem problem;
    if (!has_states(problem, low, high)) return {traced(low, high)};
    PolynomialOptions options = options_.fit;
    options.max_halvings = divisions > 0 ? 0 : std::min(options.max_halvings, kMaxFieldHalvings);
    const LensState& lens = states_.at(high)->lens;
    const Vec2 sensor_half_mm{0.5 * lens.sensor_width_mm, 0.5 * lens.sensor_height_mm};
    PolynomialSpan whole{low, high, fit_field({common_, options, problem.nodes, problem.tests, sensor_half_mm}, 1.0)};
    if (divisions == 0 || std::ranges::none_of(whole.zones, is_traced)) return {std::move(whole)};
    const double middle = between(low, high, 0.0);
    std::vector<PolynomialSpan> parts = fit_spans(low, middle, divisions - 1);
    for (PolynomialSpan& part : fit_spans(middle, high, divisions - 1)) parts.push_back(std::move(part));
    return parts;
  }

  const LensPolynomials& common_;
  const PolynomialRangeOptions& options_;
  RangeStates& states_;
  Ghost ghost_;
};

Result<std::vector<RangePositions>> positions_between(RangeStates& states) {
  std::vector<RangePositions> all;
  for (std::size_t k = 0; k + 1 < states.breaks().size(); ++k) {
    RangePositions& part = all.emplace_back();
    part.low = states.breaks()[k];
    part.high = states.breaks()[k + 1];
    for (int n = 0; n < kPositionNodes; ++n) {
      const double at = n == 0                    ? part.high
                        : n == kPositionNodes - 1 ? part.low
                                                  : between(part.low, part.high, node_coordinate(n, kPositionNodes));
      const RangeState* const state = states.at(at);
      if (state == nullptr) return invalid_argument("the lens cannot be set to all states of the range");
      part.z_mm.push_back(positions_of(state->lens));
    }
  }
  return all;
}

// The coordinate of a lens, if it is a state of this part of the range.
std::optional<double> coordinate_in(const RangePositions& positions, PolynomialVariable variable,
                                    const LensState& lens) {
  const std::vector<double> own_mm = positions_of(lens);
  if (positions.z_mm.front().size() != own_mm.size()) return std::nullopt;
  // Positions in files need not be those of this lens. Those of surfaces show the zoom; the sensor follows the focus.
  const auto surfaces_of = [](const std::vector<double>& z_mm) { return std::span(z_mm).first(z_mm.size() - 1); };
  const double along =
      between_positions(surfaces_of(positions.z_mm.back()), surfaces_of(positions.z_mm.front()), surfaces_of(own_mm));
  const double coordinate = variable == PolynomialVariable::Zoom ? std::lerp(positions.low, positions.high, along)
                                                                 : 1.0 / lens.object_distance_mm;
  const double spare = kRounding * (positions.high - positions.low);
  if (!(coordinate >= positions.low - spare && coordinate <= positions.high + spare)) return std::nullopt;
  const std::vector<double> weights =
      node_weights(static_cast<int>(positions.z_mm.size()), within(positions.low, positions.high, coordinate));
  for (std::size_t k = 0; k < own_mm.size(); ++k) {
    double z_mm = 0.0;
    for (std::size_t n = 0; n < weights.size(); ++n) z_mm += weights[n] * positions.z_mm[n][k];
    if (!(std::abs(z_mm - own_mm[k]) <= kPositionTolerance_mm)) return std::nullopt;
  }
  return coordinate;
}

GhostPolynomials ghost_at(const GhostRange& ghost, double coordinate) {
  const auto after = [&](const PolynomialSpan& span) { return coordinate <= span.high; };
  auto found = std::ranges::find_if(ghost.spans, after);
  if (found == ghost.spans.end()) --found;
  const auto count = static_cast<int>(found->zones.front().size());
  const std::vector<double> weights = node_weights(count, within(found->low, found->high, coordinate));
  GhostPolynomials out{ghost.ghost, {}};
  for (const std::vector<PolynomialZone>& nodes : found->zones) {
    PolynomialZone zone = zone_between(nodes, weights);
    if (!out.zones.empty()) zone.field_low = out.zones.back().field_high;  // which roundings may separate
    // Files may have nodes between which there is nothing sensible.
    const bool is_sound = zone.field_high > zone.field_low && zone.radius_mm > 0.0;
    if (zone.state == PolynomialZone::State::Fitted && !is_sound) {
      zone = zone_frame(nodes, weights);
      zone.state = PolynomialZone::State::Traced;
    }
    out.zones.push_back(std::move(zone));
  }
  return out;
}

}  // namespace
}  // namespace contrejour::inline internal::polynomial

namespace contrejour {

using namespace polynomial;

Result<LensPolynomialRange> fit_polynomial_range(const Prescription& lens, const LensSettings& settings,
                                                 const PolynomialRangeOptions& options, const Context& context) {
  if (const auto good = check_fit_options(options.fit); !good) return tl::unexpected(good.error());
  if (options.max_divisions < 0 || options.max_divisions > kMaxDivisions)
    return invalid_argument(
        fmt::format("the range cannot be divided {} times; choose 0 to {}", options.max_divisions, kMaxDivisions));
  const auto states = RangeStates::create(lens, settings, options);
  if (!states) return tl::unexpected(states.error());
  const LensState& first = (*states)->at((*states)->breaks().front())->lens;
  if (const auto good = check_lens(first); !good) return tl::unexpected(good.error());
  const auto ghosts = ghosts_to_fit(first, options.fit);
  if (!ghosts) return tl::unexpected(ghosts.error());
  auto positions = positions_between(**states);
  if (!positions) return tl::unexpected(positions.error());
  LensPolynomialRange range;
  range.variable = options.variable;
  range.common = without_ghosts(first, options.fit);
  range.common.fingerprint = polynomial_fingerprint(without_positions(first));
  range.positions = std::move(*positions);
  range.ends_mm = (*states)->ends_mm();
  for (const double end : (*states)->breaks())
    range.common.max_field = std::max(range.common.max_field, (*states)->at(end)->largest_field);
  range.ghosts.resize(ghosts->size());
  const bool done = parallel_for(ghosts->size(), context, [&](std::size_t k) {
    range.ghosts[k] = GhostRangeFit(range.common, options, **states, (*ghosts)[k]).run();
  });
  if (!done) return interrupted();
  return range;
}

Result<LensPolynomials> polynomials_at(const LensPolynomialRange& range, const LensState& lens) {
  std::optional<double> coordinate;
  if (polynomial_fingerprint(without_positions(lens)) == range.common.fingerprint)
    for (const RangePositions& part : range.positions)
      if (!coordinate) coordinate = coordinate_in(part, range.variable, lens);
  if (!coordinate)
    return invalid_argument(
        fmt::format("the fit is one of '{}' over a range of {} that this lens is not in, or of another lens or with "
                    "other coatings",
                    range.common.lens, range.variable == PolynomialVariable::Zoom ? "zoom" : "focus"));
  LensPolynomials out = range.common;
  out.fingerprint = polynomial_fingerprint(lens);
  out.max_field = 0.0;
  for (const GhostRange& ghost : range.ghosts) {
    out.ghosts.push_back(ghost_at(ghost, *coordinate));
    out.max_field = std::max(out.max_field, out.ghosts.back().zones.back().field_high);
  }
  return out;
}

double traced_flux_fraction(const LensPolynomialRange& range) {
  double traced = 0.0, sum = 0.0;
  for (const GhostRange& ghost : range.ghosts) {
    for (const PolynomialSpan& span : ghost.spans) {
      for (const std::vector<PolynomialZone>& nodes : span.zones) {
        for (const PolynomialZone& zone : nodes) {
          const double area = zone.field_high * zone.field_high - zone.field_low * zone.field_low;
          const double flux = zone.flux_mm2 * area * (span.high - span.low) / static_cast<double>(nodes.size());
          sum += flux;
          if (is_traced(nodes)) traced += flux;
        }
      }
    }
  }
  return sum > 0.0 ? traced / sum : 0.0;
}

}  // namespace contrejour
