// SPDX-License-Identifier: Apache-2.0
// Fits of a range of zoom or focus, at states between their nodes: against the scalar tracer, which shares no code with
// the rays of a fit, and against a fit of the state itself.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/polynomial_range.h"
#include "polynomial/zone_nodes.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

Prescription prescription(const char* name) {
  auto lens = find_lens(name);
  REQUIRE(lens.has_value());
  return std::move(*lens);
}

LensState state_of(const Prescription& lens, const LensSettings& settings) {
  auto state = configure_lens(lens, settings);
  REQUIRE(state.has_value());
  state->stop_radius_mm = state->surfaces[static_cast<std::size_t>(state->stop_index)].semi_diameter_mm;
  return std::move(*state);
}

const std::vector<Ghost> kZoomGhosts{{3, 4}, {5, 6}};

const LensPolynomialRange& zoom_fit() {
  static const LensPolynomialRange fit = [] {
    auto made = fit_polynomial_range(
        prescription("itoh-zoom"), {},
        {.from_mm = 100.0, .to_mm = 146.0, .max_divisions = 1, .fit = {.max_halvings = 0, .ghosts = kZoomGhosts}});
    REQUIRE(made.has_value());
    return std::move(*made);
  }();
  return fit;
}

struct RangeErrors {
  std::vector<double> position_px, stop, transmittance, apart_px;
  int wrongly_open = 0;
};

double clearance_of(double relative_height, const std::array<Vec2, kMaxStopCrossings>& stop) {
  double largest = relative_height;
  for (const Vec2& at : stop) largest = std::max(largest, length(at));
  return largest;
}

// Rays through a grid over the bounds at one field, against traced ones and against `other`, the fit of the state.
void compare_state(const LensState& lens, const LensPolynomials& fit, const LensPolynomials* other,
                   RangeErrors& errors) {
  constexpr double kField = 0.2, kLambda_nm = 560.0;
  for (const GhostPolynomials& ghost : fit.ghosts) {
    const PolynomialZone* const zone = find_zone(ghost, kField);
    if (zone == nullptr || zone->state != PolynomialZone::State::Fitted) continue;
    const PolynomialZone* own = nullptr;
    if (other != nullptr)
      for (const GhostPolynomials& of_state : other->ghosts)
        if (of_state.ghost == ghost.ghost) own = find_zone(of_state, kField);
    const OpticalPath path = ghost_path(lens, ghost.ghost, kLambda_nm);
    const auto bounds = std::ranges::min_element(
        zone->bounds, {}, [](const PolynomialBounds& b) { return std::abs(static_cast<double>(b.field) - kField); });
    for (int ix = 0; ix <= 20; ++ix) {
      for (int iy = 0; iy <= 20; ++iy) {
        const Vec2 at{std::lerp(bounds->low_x_mm, bounds->high_x_mm, static_cast<float>(ix) / 20.0F),
                      bounds->half_y_mm * iy / 20.0};
        const TracedRay traced = trace(path, {{at.x, at.y, fit.entrance_z_mm}, normalized(Vec3{kField, 0.0, 1.0})});
        const PolynomialRay fitted = evaluate(fit, *zone, kField, at, kLambda_nm);
        const double exact = traced.status == RayStatus::Ok ? clearance_of(traced.relative_height, traced.stop) : 1e9;
        if (exact > 1.02 && clearance_of(fitted.relative_height, fitted.stop) <= 1.0) ++errors.wrongly_open;
        if (exact > 1.0) continue;
        errors.position_px.push_back(length(traced.sensor_mm - fitted.sensor_mm) / fit.pixel_mm);
        errors.stop.push_back(length(traced.stop[0] - fitted.stop[0]));
        errors.transmittance.push_back(std::abs(traced.transmission - fitted.transmittance));
        if (own != nullptr && own->state == PolynomialZone::State::Fitted)
          errors.apart_px.push_back(
              length(evaluate(*other, *own, kField, at, kLambda_nm).sensor_mm - fitted.sensor_mm) / fit.pixel_mm);
      }
    }
  }
}

double p95(std::vector<double> values) {
  REQUIRE(values.size() > 50);
  std::ranges::sort(values);
  return values[values.size() * 95 / 100];
}

}  // namespace

TEST_CASE("weights of nodes give polynomials of lower degree exactly") {
  const std::vector<double> weights = polynomial::node_weights(5, 0.37);
  double sum = 0.0, fourth = 0.0;
  for (int n = 0; n < 5; ++n) {
    sum += weights[static_cast<std::size_t>(n)];
    fourth += weights[static_cast<std::size_t>(n)] * std::pow(polynomial::node_coordinate(n, 5), 4.0);
  }
  CHECK(sum == test::approx(1.0).epsilon(1e-12));
  CHECK(fourth == test::approx(std::pow(0.37, 4.0)).epsilon(1e-12));
  CHECK(polynomial::node_weights(5, -1.0) == std::vector<double>{0.0, 0.0, 0.0, 0.0, 1.0});
}

TEST_CASE("one fit of a zoom holds between its nodes [slow]") {
  const Prescription lens = prescription("itoh-zoom");
  CHECK(traced_flux_fraction(zoom_fit()) < 0.2);
  for (const double focal_mm : {100.0, 109.0, 131.0}) {
    CAPTURE(focal_mm);
    const LensState state = state_of(lens, {.focal_length_mm = focal_mm});
    const auto fit = polynomials_at(zoom_fit(), state);
    REQUIRE(fit.has_value());
    CHECK(fit->fingerprint == polynomial_fingerprint(state));
    const auto own = fit_polynomials(state, {.max_halvings = 0, .ghosts = {kZoomGhosts[0]}});
    REQUIRE(own.has_value());
    RangeErrors errors;
    compare_state(state, *fit, &*own, errors);
    CHECK(p95(errors.position_px) <= 0.25);
    CHECK(p95(errors.stop) <= 1e-3);
    CHECK(p95(errors.transmittance) <= 2e-3);
    CHECK(p95(errors.apart_px) <= 0.25);
    CHECK(errors.wrongly_open == 0);
  }
}

TEST_CASE("one fit of a range of focus holds between its nodes [slow]") {
  const Prescription lens = prescription("tessar");
  const auto range = fit_polynomial_range(lens, {},
                                          {.variable = PolynomialVariable::Focus,
                                           .from_mm = 800.0,
                                           .to_mm = INFINITY,
                                           .max_divisions = 0,
                                           .fit = {.max_halvings = 0, .ghosts = {{1, 4}, {3, 4}}}});
  REQUIRE(range.has_value());
  const LensState state = state_of(lens, {.object_distance_mm = 1300.0});
  const auto fit = polynomials_at(*range, state);
  REQUIRE(fit.has_value());
  RangeErrors errors;
  compare_state(state, *fit, nullptr, errors);
  CHECK(p95(errors.position_px) <= 0.25);
  CHECK(errors.wrongly_open == 0);
  // Another zoom of another lens, other coatings, and a nearer object.
  CHECK_FALSE(polynomials_at(*range, state_of(lens, {.object_distance_mm = 700.0})).has_value());
  CHECK_FALSE(polynomials_at(*range, state_of(lens, {.coating = Coating{}})).has_value());
  CHECK_FALSE(polynomials_at(*range, state_of(prescription("itoh-zoom"), {})).has_value());
}

TEST_CASE("a zoom at another focus than that of its range is refused") {
  const Prescription lens = prescription("itoh-zoom");
  CHECK(polynomials_at(zoom_fit(), state_of(lens, {.focal_length_mm = 120.0})).has_value());
  CHECK_FALSE(
      polynomials_at(zoom_fit(), state_of(lens, {.focal_length_mm = 120.0, .object_distance_mm = 5000.0})).has_value());
}

TEST_CASE("a file of a range is read as the values that were written, and refused where it is damaged") {
  const std::string bytes = write_polynomial_range(zoom_fit());
  const auto read = read_any_polynomials(bytes, "a.poly");
  REQUIRE(read.has_value());
  CHECK(write_polynomial_range(std::get<LensPolynomialRange>(*read)) == bytes);
  CHECK(read_polynomials(bytes, "a.poly").error().to_string().find("polynomial at") != std::string::npos);
  for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 100)
    CHECK_FALSE(read_any_polynomials(std::string_view(bytes).substr(0, size), "a.poly").has_value());
  const LensState state = state_of(prescription("itoh-zoom"), {.focal_length_mm = 120.0});
  std::mt19937 random(5);
  for (int k = 0; k < 50; ++k) {
    std::string damaged = bytes;
    for (int flips = 0; flips < 3; ++flips) damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
    const auto again = read_any_polynomials(damaged, "a.poly");
    if (!again || !std::holds_alternative<LensPolynomialRange>(*again)) continue;
    const auto fit = polynomials_at(std::get<LensPolynomialRange>(*again), state);
    if (!fit) continue;
    for (const GhostPolynomials& ghost : fit->ghosts)
      for (const PolynomialZone& zone : ghost.zones)
        if (zone.state == PolynomialZone::State::Fitted)
          CHECK_FALSE(std::isnan(evaluate(*fit, zone, zone.field_high, {0.1, 0.2}, 550.0).transmittance));
  }
}

TEST_CASE("ranges that are empty or that the lens does not have are refused") {
  const Prescription lens = prescription("itoh-zoom");
  CHECK_FALSE(fit_polynomial_range(lens, {}, {.from_mm = 120.0, .to_mm = 120.0}).has_value());
  CHECK_FALSE(fit_polynomial_range(lens, {}, {.from_mm = 50.0, .to_mm = 120.0}).has_value());
  CHECK_FALSE(fit_polynomial_range(lens, {}, {.from_mm = 100.0, .to_mm = 120.0, .max_divisions = 9}).has_value());
}
