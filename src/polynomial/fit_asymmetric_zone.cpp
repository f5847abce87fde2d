// SPDX-License-Identifier: Apache-2.0
#include "polynomial/fit_asymmetric_zone.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "polynomial/asymmetric_rays.h"
#include "polynomial/asymmetric_systems.h"
#include "polynomial/chebyshev_basis.h"
#include "polynomial/fit_zone.h"
#include "polynomial/left_out_rays.h"
#include "polynomial/node_polynomials.h"
#include "polynomial/zone_nodes.h"

namespace contrejour::inline internal::polynomial {
namespace {

constexpr int kFirstDegree = 5, kDegreeStep = 2;
// Directions of a fit, by the number of axes in which the zone is even. At order 9, 55 products of polynomials in the
// directions alone must be determined.
constexpr std::array kFitFields{110, 80, 64};
constexpr int kMostTerms = 730;  // order 13, 11 or 9 for two, one or no mirror planes; beyond, a system takes seconds
constexpr int kTestedDirections = 24, kTestedAtDirection = 32, kBlockedAtDirection = 96, kRimRaysAtDirection = 64;
constexpr std::size_t kFirstTestedField = 50'021;  // in the sequence of directions

int even_axes(const AsymmetricZone& zone) { return (zone.even_x ? 1 : 0) + (zone.even_y ? 1 : 0); }

// A polynomial or two of the fit, whose degree rises until its errors reach the target.
struct AsymmetricOutput {
  const WeightedRays* weighted = nullptr;
  int wavelength_step = 1;
  double target = 0.0, accepted = 0.0, negligible = 0.0;
  std::function<Vec2(const RayTable&, std::size_t)> value;  // of a scalar: x
  std::function<std::vector<double>(const AsymmetricVector&)> errors;  // rising
  bool is_vector = false;
  AsymmetricVector best = {};
  double p95 = std::numeric_limits<double>::infinity();
  bool done = false;
};

class AsymmetricFit {
 public:
  AsymmetricFit(const AsymmetricProblem& problem, AsymmetricZone& zone, const FitRays& rays)
      : problem_(problem), zone_(zone), rays_(rays), left_out_(left_out_of(problem, zone)) {
    for (const RayStart& start : rays.nodes.front().starts)
      points_.push_back(asymmetric_point(zone, {start.field, start.field_y}, start.entrance_mm));
    for (const RayStart& start : left_out_.starts())
      tested_.push_back(asymmetric_point(zone, {start.field, start.field_y}, start.entrance_mm));
    for (const RayStart& start : left_out_.blocked_starts())
      blocked_.push_back(asymmetric_point(zone, {start.field, start.field_y}, start.entrance_mm));
  }

  // Returns whether all outputs are accurate enough.
  bool run() {
    list_outputs();
    int max_degree = std::min(problem_.options.max_order, kMaxAsymmetricDegree);
    while (asymmetric_term_count(max_degree, parities_of_scalar(zone_)) > kMostTerms) max_degree -= kDegreeStep;
    for (int degree = kFirstDegree; degree <= max_degree; degree += kDegreeStep) {
      AsymmetricSystems systems(degree, points_);
      for (AsymmetricOutput& output : outputs_)
        if (!output.done && !raise(output, systems, (max_degree - degree) / kDegreeStep)) return give_up();
    }
    take_outputs();
    return std::ranges::all_of(outputs_, [](const AsymmetricOutput& o) { return o.p95 <= o.accepted; }) &&
           !left_out_.brings_light_in(vector_at(zone_.sensor_mm)) &&
           !left_out_.admits_blocked_light(clearances(tested_), clearances(blocked_));
  }

  [[nodiscard]] int rays() const { return left_out_.open_rays(); }

 private:
  static LeftOutRays left_out_of(const AsymmetricProblem& problem, const AsymmetricZone& zone) {
    std::vector<RayStart> starts =
        starts_within(zone, {kTestedDirections, kTestedAtDirection, kFirstTestedField, kFirstLeftOut});
    std::vector<RayStart> blocked = starts_within(
        zone,
        {kTestedDirections, kBlockedAtDirection, kFirstTestedField + kTestedDirections, kFirstLeftOut + starts.size()});
    return {problem.lens, problem.rays, std::move(starts), std::move(blocked), problem.sensor_half_mm};
  }

  void list_outputs() {
    const PolynomialOptions& options = problem_.options;
    const double pixel_mm = problem_.lens.pixel_mm, target_mm = options.target_px * pixel_mm;
    const double edge = kFractionOfEdge * options.edge;
    // With equal weights both have the same systems.
    const bool same = rays_.for_sensor.weight == rays_.for_light.weight;
    outputs_.push_back({same ? &rays_.for_light : &rays_.for_sensor, kWavelengthStep, target_mm,
                        options.position_px * pixel_mm, kNegligible * target_mm,
                        [](const RayTable& t, std::size_t k) { return Vec2{t.sensor_x_mm[k], t.sensor_y_mm[k]}; },
                        [this](const AsymmetricVector& v) { return left_out_.position_errors_mm(vector_at(v)); },
                        true});
    crossings_ = rays_.nodes.front().middle().stop.size();
    for (std::size_t c = 0; c < crossings_; ++c)
      outputs_.push_back({&rays_.for_edges, kWavelengthStep, edge, options.edge, kNegligible * edge,
                          [c](const RayTable& t, std::size_t k) { return Vec2{t.stop[c][0][k], t.stop[c][1][k]}; },
                          [this, c](const AsymmetricVector& v) { return left_out_.stop_errors(vector_at(v), c); },
                          true});
    for (const int step : blocking_steps()) {
      steps_.push_back(step);
      const auto rim = static_cast<std::size_t>(step);
      outputs_.push_back(
          {&rays_.for_edges, kWavelengthStep, edge, options.edge, kNegligible * edge,
           [rim](const RayTable& t, std::size_t k) { return Vec2{t.rim_squared[rim][k], 0.0}; },
           [this, step](const AsymmetricVector& v) { return left_out_.rim_errors(scalar_at(v.x), step); }});
    }
    const double target = kFractionOfTransmittance * options.transmittance;
    const double largest = *std::ranges::max_element(rays_.nodes.front().middle().transmission);
    outputs_.push_back({&rays_.for_light, 1, target, options.transmittance, kNegligible * target * largest,
                        [](const RayTable& t, std::size_t k) { return Vec2{t.transmission[k], 0.0}; },
                        [this](const AsymmetricVector& v) { return left_out_.transmittance_errors(scalar_at(v.x)); }});
  }

  [[nodiscard]] std::vector<int> blocking_steps() const {
    std::vector<int> steps;
    const std::vector<RayStart> starts =
        starts_within(zone_, {kFitFields[static_cast<std::size_t>(even_axes(zone_))], kRimRaysAtDirection, 1, 1});
    add_blocking_steps(problem_.rays.trace(starts, wavelength_at(problem_.lens, 0.0)), steps);
    return steps;
  }

  // Fits an output at one more degree; false if it cannot be expected to become accurate enough.
  bool raise(AsymmetricOutput& output, AsymmetricSystems& systems, int degrees_left) {
    const std::vector<RayTable>& tables = rays_.nodes.front().tables;
    const auto fitted = [&](const Parities& parities, bool along_y) {
      const RayValue value = [&](std::size_t wavelength, std::size_t ray) {
        const Vec2 both_axes = output.value(tables[wavelength], ray);
        return along_y ? both_axes.y : both_axes.x;
      };
      return systems.fit(*output.weighted, parities, output.wavelength_step, value, output.negligible);
    };
    const auto x = fitted(output.is_vector ? parities_of_x(zone_) : parities_of_scalar(zone_), false);
    const auto y = output.is_vector && x ? fitted(parities_of_y(zone_), true) : std::optional(ChebyshevSum{});
    if (!x || !y) {  // too few rays
      output.done = true;
      return output.p95 <= output.accepted;
    }
    const AsymmetricVector tried{*x, *y};
    const double p95 = quantile(output.errors(tried), 0.95);
    if (!(p95 < output.p95)) return degrees_left > 0 || output.p95 <= output.accepted;
    const bool hopeless = is_hopeless(p95, output.p95, degrees_left, output.accepted);
    output.p95 = p95;
    output.best = tried;
    output.done = p95 <= output.target;
    return output.done || !hopeless;
  }

  bool give_up() {
    take_accuracy();
    return false;
  }

  void take_accuracy() {
    const double pixel_mm = problem_.lens.pixel_mm;
    PolynomialAccuracy& accuracy = zone_.accuracy;
    const AsymmetricOutput& sensor = outputs_.front();
    const std::vector<double> errors = sensor.errors(sensor.best);
    accuracy.position_p50_px = quantile(errors, 0.5) / pixel_mm;
    accuracy.position_p95_px = quantile(errors, 0.95) / pixel_mm;
    accuracy.position_max_px = quantile(errors, 1.0) / pixel_mm;
    for (std::size_t k = 1; k + 1 < outputs_.size(); ++k)
      accuracy.edge_p95 = std::max(accuracy.edge_p95, outputs_[k].p95);
    accuracy.transmittance_p95 = outputs_.back().p95;
  }

  void take_outputs() {
    take_accuracy();
    zone_.order = std::max(outputs_.front().best.x.degree, 1);
    zone_.sensor_mm = outputs_.front().best;
    for (std::size_t c = 0; c < crossings_; ++c) zone_.stop.push_back(outputs_[1 + c].best);
    for (std::size_t r = 0; r < steps_.size(); ++r)
      zone_.rims.push_back({steps_[r], outputs_[1 + crossings_ + r].best.x});
    zone_.transmittance = outputs_.back().best.x;
  }

  [[nodiscard]] LeftOutRays::VectorAt vector_at(const AsymmetricVector& v) const {
    return [this, &v](const LeftOutRay& at) {
      const AsymmetricPoint& point = tested_[at.ray];
      const double wavelength = kTestedWavelengths[at.wavelength];
      return Vec2{value_of(v.x, parities_of_x(zone_), point, wavelength),
                  value_of(v.y, parities_of_y(zone_), point, wavelength)};
    };
  }
  [[nodiscard]] LeftOutRays::ScalarAt scalar_at(const ChebyshevSum& sum) const {
    return [this, &sum](const LeftOutRay& at) {
      return value_of(sum, parities_of_scalar(zone_), tested_[at.ray], kTestedWavelengths[at.wavelength]);
    };
  }
  [[nodiscard]] LeftOutRays::ClearanceAt clearances(const std::vector<AsymmetricPoint>& points) const {
    return [this, &points](const LeftOutRay& at) {
      const AsymmetricPoint& point = points[at.ray];
      const double wavelength = kTestedWavelengths[at.wavelength];
      double clearance = 0.0;
      for (const PolynomialRim& rim : zone_.rims) {
        clearance = std::max(
            clearance, std::sqrt(std::max(0.0, value_of(rim.squared, parities_of_scalar(zone_), point, wavelength))));
        if (clearance > 1.0) return clearance;
      }
      for (const AsymmetricVector& crossing : zone_.stop)
        clearance = std::max(clearance, std::hypot(value_of(crossing.x, parities_of_x(zone_), point, wavelength),
                                                   value_of(crossing.y, parities_of_y(zone_), point, wavelength)));
      return clearance;
    };
  }

  const AsymmetricProblem& problem_;
  AsymmetricZone& zone_;
  const FitRays& rays_;
  LeftOutRays left_out_;
  std::vector<AsymmetricPoint> points_, tested_, blocked_;
  std::size_t crossings_ = 0;
  std::vector<int> steps_;
  std::vector<AsymmetricOutput> outputs_;
};

}  // namespace

AsymmetricZone fit_asymmetric_zone(const AsymmetricProblem& problem, const AsymmetricZone& place) {
  AsymmetricZone zone = with_bounds(problem, place);
  if (std::ranges::none_of(zone.bounds, [](const AsymmetricBounds& b) { return lets_light_in(b); })) return zone;
  set_pupil_coordinates(zone);
  const int fields = kFitFields[static_cast<std::size_t>(even_axes(zone))];
  const FitRays rays = fit_rays(problem, zone, fields);
  zone.flux_mm2 = flux_mm2(zone, rays.nodes.front(), fields);
  AsymmetricFit fit(problem, zone, rays);
  const bool fitted = fit.run();
  zone.accuracy.rays = fit.rays();
  zone.state = fitted ? PolynomialZone::State::Fitted : PolynomialZone::State::Traced;
  if (fitted) return zone;
  AsymmetricZone traced = place;
  traced.state = PolynomialZone::State::Traced;
  traced.accuracy = zone.accuracy;
  traced.flux_mm2 = zone.flux_mm2;
  traced.bounds_side = zone.bounds_side;
  traced.bounds = zone.bounds;
  return traced;
}

}  // namespace contrejour::inline internal::polynomial
