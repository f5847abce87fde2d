// SPDX-License-Identifier: Apache-2.0
#include "polynomial/fit_zone.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "polynomial/chebyshev_basis.h"
#include "polynomial/node_polynomials.h"
#include "polynomial/zone_check.h"
#include "polynomial/zone_nodes.h"

namespace contrejour::inline internal::polynomial {
namespace {

constexpr int kFields = 19;
constexpr int kRimRaysAtField = 400;  // at one wavelength, that show which rims block
constexpr int kMinDegree = 2;  // order 5

// The errors that a polynomial should have, up to which higher degrees are tried, and those up to which it is accepted.
struct Tolerated {
  double target = 0.0, accepted = 0.0;
};

// The polynomial of the lowest degree whose errors reach the target, or else the best one.
template <class Polynomials, class Fit, class Error>
double raise_degree(const Systems& systems, int max_degree, const Tolerated& tolerated, Polynomials& best,
                    const Fit& fit, const Error& p95_of) {
  double best_p95 = std::numeric_limits<double>::infinity();
  for (int degree = kMinDegree; degree <= max_degree && systems.has_enough_rays(degree); ++degree) {
    Polynomials tried = fit(degree);
    const double p95 = p95_of(tried);
    if (!(p95 < best_p95)) continue;  // not a number, too
    const bool stops = p95 <= tolerated.target || is_hopeless(p95, best_p95, max_degree - degree, tolerated.accepted);
    best_p95 = p95;
    best = std::move(tried);
    if (stops) break;
  }
  return best_p95;
}

// The checks at all test states.
class Checks {
 public:
  Checks(const ZoneProblem& problem, std::span<const PolynomialZone> zones) : problem_(problem) {
    for (const TestState& test : problem.tests) {
      frames_.push_back(zone_frame(zones, test.weights));
      checks_.emplace_back(problem.lens, *test.rays, frames_.back(), problem.sensor_half_mm);
    }
  }

  // The largest of a quantile over the states. errors_of(check, polynomial): the errors at one state, rising.
  template <class Polynomial, class ErrorsOf>
  [[nodiscard]] double worst(const std::vector<Polynomial>& nodes, double fraction, const ErrorsOf& errors_of) const {
    double worst = 0.0;
    for (std::size_t t = 0; t < checks_.size(); ++t) {
      if (checks_[t].rays() == 0 && checks_.size() > 1) continue;  // a state without light
      const double error = quantile(errors_of(checks_[t], interpolated(nodes, problem_.tests[t].weights)), fraction);
      worst = error <= worst ? worst : error;  // keeps what is not a number
    }
    return worst;
  }

  [[nodiscard]] bool admit_blocked_light(std::span<const PolynomialZone> zones) const {
    for (std::size_t t = 0; t < checks_.size(); ++t)
      if (checks_[t].admits_blocked_light(problem_.lens, zone_between(zones, problem_.tests[t].weights))) return true;
    return false;
  }

  [[nodiscard]] bool bring_light_in(const NodeVectors& sensor) const {
    for (std::size_t t = 0; t < checks_.size(); ++t)
      if (checks_[t].brings_light_in(interpolated(sensor, problem_.tests[t].weights))) return true;
    return false;
  }

  [[nodiscard]] int rays() const {
    int sum = 0;
    for (const ZoneCheck& check : checks_) sum += check.rays();
    return sum;
  }

 private:
  const ZoneProblem& problem_;
  std::vector<PolynomialZone> frames_;
  std::vector<ZoneCheck> checks_;
};

// Fits all outputs of the zone at all nodes.
class ZoneFit {
 public:
  ZoneFit(const ZoneProblem& problem, const FitRays& rays, const Checks& checks, std::vector<PolynomialZone>& zones)
      : problem_(problem), options_(problem.options), rays_(rays), checks_(checks), zones_(zones),
        sensor_(rays, rays.for_sensor, rays.light_points), light_(rays, rays.for_light, rays.light_points),
        edges_(rays, rays.for_edges, rays.points) {}

  // Returns whether all outputs are accurate enough.
  bool run() {
    if (!fit_sensor()) return false;
    for (std::size_t c = 0; c < rays_.nodes.front().middle().stop.size(); ++c) fit_stop(c);
    for (const int step : blocking_steps()) fit_rim(step);
    if (!(accuracy_.edge_p95 <= options_.edge)) return false;
    fit_transmittance();
    return accuracy_.transmittance_p95 <= options_.transmittance && !checks_.admit_blocked_light(zones_);
  }

  [[nodiscard]] const PolynomialAccuracy& accuracy() const { return accuracy_; }

 private:
  bool fit_sensor() {
    const double pixel_mm = problem_.lens.pixel_mm, target_mm = options_.target_px * pixel_mm;
    const auto errors = [](const ZoneCheck& check, const ChebyshevVector& v) { return check.position_errors_mm(v); };
    NodeVectors sensor(zones_.size());
    OutputFit fit(sensor_.vectors(), kWavelengthStep,
                  {[](const RayTable& t, std::size_t k) { return t.sensor_x_mm[k]; },
                   [](const RayTable& t, std::size_t k) { return t.sensor_y_mm[k]; }},
                  kNegligible * target_mm);
    raise_degree(
        sensor_, max_degree_, {target_mm, options_.position_px * pixel_mm}, sensor,
        [&](int degree) { return fit.vectors(degree); },
        [&](const NodeVectors& tried) { return checks_.worst(tried, 0.95, errors); });
    accuracy_.position_p50_px = checks_.worst(sensor, 0.5, errors) / pixel_mm;
    accuracy_.position_p95_px = checks_.worst(sensor, 0.95, errors) / pixel_mm;
    accuracy_.position_max_px = checks_.worst(sensor, 1.0, errors) / pixel_mm;
    const bool brings_light_in = checks_.bring_light_in(sensor);
    for (std::size_t n = 0; n < zones_.size(); ++n) {
      zones_[n].order = 2 * sensor[n].along_field.degree + 1;
      zones_[n].sensor_mm = std::move(sensor[n]);
    }
    return accuracy_.position_p95_px <= options_.position_px && !brings_light_in;
  }

  void fit_stop(std::size_t crossing) {
    const auto axis = [crossing](std::size_t of) {
      return [crossing, of](const RayTable& t, std::size_t k) { return t.stop[crossing][of][k]; };
    };
    NodeVectors stop(zones_.size());
    OutputFit fit(edges_.vectors(), kWavelengthStep, {axis(0), axis(1)}, kNegligible * edge_target_);
    const double p95 = raise_degree(
        edges_, max_degree_, {edge_target_, options_.edge}, stop, [&](int degree) { return fit.vectors(degree); },
        [&](const NodeVectors& tried) {
          return checks_.worst(tried, 0.95, [crossing](const ZoneCheck& check, const ChebyshevVector& v) {
            return check.stop_errors(v, crossing);
          });
        });
    accuracy_.edge_p95 = std::max(accuracy_.edge_p95, p95);
    for (std::size_t n = 0; n < zones_.size(); ++n) zones_[n].stop.push_back(std::move(stop[n]));
  }

  // The rims that block at any node.
  [[nodiscard]] std::vector<int> blocking_steps() const {
    std::vector<int> steps;
    for (std::size_t n = 0; n < zones_.size(); ++n)
      add_blocking_steps(problem_.nodes[n].rays->trace(starts_within(zones_[n].bounds, kRimRaysAtField, 1),
                                                       wavelength_at(problem_.lens, 0.0)),
                         steps);
    return steps;
  }

  void fit_rim(int step) {
    NodeSums squared(zones_.size());
    const auto value = [step](const RayTable& t, std::size_t k) {
      return t.rim_squared[static_cast<std::size_t>(step)][k];
    };
    OutputFit fit(edges_.scalars(), kWavelengthStep, {value}, kNegligible * edge_target_);
    const double p95 = raise_degree(
        edges_, max_degree_, {edge_target_, options_.edge}, squared, [&](int degree) { return fit.sums(degree); },
        [&](const NodeSums& tried) {
          return checks_.worst(tried, 0.95, [step](const ZoneCheck& check, const ChebyshevSum& sum) {
            return check.rim_errors(sum, step);
          });
        });
    accuracy_.edge_p95 = std::max(accuracy_.edge_p95, p95);
    for (std::size_t n = 0; n < zones_.size(); ++n) zones_[n].rims.push_back({step, std::move(squared[n])});
  }

  void fit_transmittance() {
    double largest = 0.0;
    for (const NodeRays& node : rays_.nodes)
      largest = std::max<double>(largest, *std::ranges::max_element(node.middle().transmission));
    const double target = kFractionOfTransmittance * options_.transmittance;
    NodeSums transmittance(zones_.size());
    OutputFit fit(light_.scalars(), 1, {[](const RayTable& t, std::size_t k) { return t.transmission[k]; }},
                  kNegligible * target * largest);
    accuracy_.transmittance_p95 = raise_degree(
        light_, max_degree_, {target, options_.transmittance}, transmittance,
        [&](int degree) { return fit.sums(degree); },
        [&](const NodeSums& tried) {
          return checks_.worst(tried, 0.95, [](const ZoneCheck& check, const ChebyshevSum& sum) {
            return check.transmittance_errors(sum);
          });
        });
    for (std::size_t n = 0; n < zones_.size(); ++n) zones_[n].transmittance = std::move(transmittance[n]);
  }

  const ZoneProblem& problem_;
  const PolynomialOptions& options_;
  const FitRays& rays_;
  const Checks& checks_;
  std::vector<PolynomialZone>& zones_;
  Systems sensor_, light_, edges_;
  int max_degree_ = (options_.max_order - 1) / 2;
  double edge_target_ = kFractionOfEdge * options_.edge;
  PolynomialAccuracy accuracy_;
};

// The zone at one state, with the bounds of its pupil.
PolynomialZone bounded_zone(const FitState& state, double low, double high) {
  PolynomialZone zone;
  zone.field_low = low * state.field_scale;
  zone.field_high = high * state.field_scale;
  for (int k = 0; k < kFields; ++k) {
    const double field = std::sqrt(low * low + 0.5 * (high * high - low * low) * (1.0 - node_coordinate(k, kFields)));
    zone.bounds.push_back(state.rays->bounds(field * state.field_scale));
  }
  return zone;
}

// The light at the zone's fields at the states between nodes.
std::vector<BoundsBetween> bounds_at_tests(const ZoneProblem& problem, std::span<const PolynomialZone> zones) {
  std::vector<BoundsBetween> all;
  for (const TestState& test : problem.tests) {
    BoundsBetween& between = all.emplace_back(BoundsBetween{test.weights, {}});
    for (std::size_t f = 0; f < zones.front().bounds.size(); ++f) {
      double field = 0.0;
      for (std::size_t n = 0; n < zones.size(); ++n)
        field += test.weights[n] * static_cast<double>(zones[n].bounds[f].field);
      between.bounds.push_back(test.rays->bounds(field));
    }
  }
  return all;
}

}  // namespace

bool is_hopeless(double p95, double before, int degrees_left, double accepted) {
  constexpr double kBetterThanBefore = 0.5;
  return p95 * std::pow(kBetterThanBefore * p95 / before, degrees_left) > accepted;
}

std::vector<PolynomialZone> fit_zone(const ZoneProblem& problem, double low, double high) {
  std::vector<PolynomialZone> zones;
  for (const FitState& state : problem.nodes) zones.push_back(bounded_zone(state, low, high));
  const auto is_dark = [](const PolynomialZone& zone) { return std::ranges::none_of(zone.bounds, has_light); };
  if (std::ranges::all_of(zones, is_dark)) {
    for (PolynomialZone& zone : zones) zone.bounds.clear();
    return zones;
  }
  for (PolynomialZone& zone : zones)
    if (!is_dark(zone)) set_pupil_coordinates(zone);
  if (zones.size() > 1) align_pupils(zones, bounds_at_tests(problem, zones));
  const FitRays rays = fit_rays(problem, zones);
  for (std::size_t n = 0; n < zones.size(); ++n) zones[n].flux_mm2 = flux_mm2(zones[n], rays.nodes[n]);
  const Checks checks(problem, zones);
  ZoneFit fit(problem, rays, checks, zones);
  const bool fitted = fit.run();
  for (PolynomialZone& zone : zones) {
    zone.accuracy = fit.accuracy();
    zone.accuracy.rays = checks.rays();
    zone.state = PolynomialZone::State::Fitted;
    if (fitted) continue;
    PolynomialZone traced;
    traced.state = PolynomialZone::State::Traced;
    traced.field_low = zone.field_low;
    traced.field_high = zone.field_high;
    traced.accuracy = zone.accuracy;
    traced.flux_mm2 = zone.flux_mm2;
    zone = std::move(traced);
  }
  return zones;
}

}  // namespace contrejour::inline internal::polynomial
