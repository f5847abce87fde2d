// SPDX-License-Identifier: Apache-2.0
// Fits of ghosts without axial symmetry, of anamorphic and decentred lenses, against the scalar tracer, which shares no
// code with the rays that they are fitted to.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/polynomial.h"
#include "ghosts/light_frame.h"
#include "polynomial/asymmetric_basis.h"
#include "polynomial/fitted_lens.h"

using namespace contrejour;

namespace {

LensState lens_with(const char* name, const LensSettings& settings = {}) {
  const auto lens = find_lens(name);
  REQUIRE(lens.has_value());
  const auto state = configure_lens(*lens, settings);
  REQUIRE(state.has_value());
  return *state;
}

LensState opened(LensState lens) {
  lens.stop_radius_mm = lens.surfaces[static_cast<std::size_t>(lens.stop_index)].semi_diameter_mm;
  return lens;
}

// The triplet with its first lens decentred and tilted in the y-z plane.
LensState decentred_triplet() {
  auto lens = find_lens("cooke-triplet");
  REQUIRE(lens.has_value());
  const double tilt_rad = 0.01;
  for (std::size_t k = 0; k < 2; ++k)
    lens->surfaces[k].pose = {{0.0, 0.15, 0.0}, {0.0, std::sin(tilt_rad), std::cos(tilt_rad)}};
  const auto state = configure_lens(*lens);
  REQUIRE(state.has_value());
  return *state;
}

// half_field_rad: 0: that of the frame.
LensPolynomials fit_of_one(const LensState& lens, const Ghost& ghost, int max_order, double half_field_rad) {
  auto fit = fit_polynomials(
      lens, {.half_field_rad = half_field_rad, .max_order = max_order, .max_halvings = 0, .ghosts = {ghost}});
  REQUIRE(fit.has_value());
  REQUIRE(fit->ghosts.size() == 1);
  return std::move(*fit);
}

const LensPolynomials& anamorphic_fit() {
  static const LensPolynomials fit = fit_of_one(lens_with("schneider-anamorphic-31"), {1, 2}, 9, 0.0);
  return fit;
}
const LensPolynomials& triplet_fit() {
  static const LensPolynomials fit = fit_of_one(decentred_triplet(), {1, 2}, 9, 0.15);
  return fit;
}

const AsymmetricZone* fitted_zone(const GhostPolynomials& ghost) {
  const auto found = std::ranges::find(ghost.asymmetric, PolynomialZone::State::Fitted, &AsymmetricZone::state);
  return found == ghost.asymmetric.end() ? nullptr : &*found;
}

double at_95_per_cent(std::vector<double> values) {
  REQUIRE(!values.empty());
  std::ranges::sort(values);
  return values[values.size() * 95 / 100];
}

// Compares a fit with rays of some directions, on all sides of the axis.
void check_against_tracer(const LensState& lens, const LensPolynomials& fit, double tolerance_px) {
  const GhostPolynomials& ghost = fit.ghosts.front();
  const AsymmetricZone* const zone = fitted_zone(ghost);
  INFO(ghost.asymmetric.front().accuracy.position_p95_px, " px, edge ", ghost.asymmetric.front().accuracy.edge_p95);
  REQUIRE(zone != nullptr);
  CHECK(zone->accuracy.position_p95_px <= 0.25);
  const OpticalPath path = ghost_path(lens, ghost.ghost, 587.0);
  std::vector<double> position_px, stop, transmittance;
  int wrongly_open = 0;
  for (const Vec2 s : {Vec2{0.31, 0.52}, Vec2{-0.47, 0.23}, Vec2{-0.66, -0.35}, Vec2{0.58, -0.71}}) {
    const Vec2 tangents = polynomial::tangents_at(*zone, s);
    const AsymmetricBounds bounds = polynomial::bounds_between(*zone, tangents);
    double largest = 0.0;
    std::vector<std::pair<double, double>> transmittances;
    for (int ix = 0; ix <= 20; ++ix) {
      for (int iy = 0; iy <= 20; ++iy) {
        const Vec2 at{std::lerp(bounds.low_x_mm, bounds.high_x_mm, ix / 20.0F),
                      std::lerp(bounds.low_y_mm, bounds.high_y_mm, iy / 20.0F)};
        const TracedRay traced =
            trace(path, {{at.x, at.y, fit.entrance_z_mm}, normalized(Vec3{tangents.x, tangents.y, 1.0})});
        const auto fitted = evaluate(fit, ghost, tangents, at, 587.0);
        REQUIRE(fitted.has_value());
        const double clearance = std::max(traced.relative_height, length(traced.stop[0]));
        const bool arrives = traced.status == RayStatus::Ok;
        if ((!arrives || clearance > 1.05) && std::max(fitted->relative_height, length(fitted->stop[0])) <= 1.0)
          ++wrongly_open;
        if (!arrives || clearance > 1.0) continue;
        position_px.push_back(length(traced.sensor_mm - fitted->sensor_mm) / fit.pixel_mm);
        stop.push_back(length(traced.stop[0] - fitted->stop[0]));
        transmittances.emplace_back(traced.transmission, fitted->transmittance);
        largest = std::max(largest, traced.transmission);
      }
    }
    for (const auto& [a, b] : transmittances) transmittance.push_back(std::abs(a - b) / largest);
  }
  CHECK(position_px.size() > 200);
  CHECK(wrongly_open == 0);
  CHECK(at_95_per_cent(position_px) <= tolerance_px);
  CHECK(at_95_per_cent(stop) <= 1e-3);
  CHECK(at_95_per_cent(transmittance) <= 2e-3);
}

}  // namespace

TEST_CASE("a ghost of an anamorphic lens, with two mirror planes, agrees with the scalar tracer") {
  const LensState lens = opened(lens_with("schneider-anamorphic-31"));
  const GhostPolynomials& ghost = anamorphic_fit().ghosts.front();
  CHECK((ghost.mirror_x && ghost.mirror_y));
  check_against_tracer(lens, anamorphic_fit(), 0.25);
}

TEST_CASE("a ghost of a lens decentred in one plane, with one mirror plane, agrees with the scalar tracer") {
  const GhostPolynomials& ghost = triplet_fit().ghosts.front();
  CHECK((ghost.mirror_x && !ghost.mirror_y));
  check_against_tracer(opened(decentred_triplet()), triplet_fit(), 0.25);
}

TEST_CASE("a ghost of a lens with errors in all directions has no mirror plane [slow]") {
  const LensState lens = lens_with("cooke-triplet", {.build = {0.005, 0.1, 3}});
  const LensPolynomials fit = fit_of_one(lens, {1, 2}, 9, 0.15);
  CHECK((!fit.ghosts.front().mirror_x && !fit.ghosts.front().mirror_y));
  check_against_tracer(opened(lens), fit, 0.25);
}

TEST_CASE("packets give the values of evaluate() for light from all sides") {
  for (const LensPolynomials* const fit : {&anamorphic_fit(), &triplet_fit()}) {
    const polynomial::FittedLens lens(std::make_shared<const LensPolynomials>(*fit));
    const GhostPolynomials& ghost = fit->ghosts.front();
    REQUIRE(fitted_zone(ghost) != nullptr);
    const AsymmetricZone& zone = *fitted_zone(ghost);
    constexpr double kPlane_mm = 2.5, kSmaller = 0.6, kLambda_nm = 487.0;
    int compared = 0;
    for (const Vec2 s : {Vec2{0.3, 0.4}, Vec2{-0.5, 0.2}, Vec2{-0.1, -0.6}}) {
      const Vec2 tangents = polynomial::tangents_at(zone, s);
      const LightFrame light(LightSource(normalized({tangents.x, tangents.y, 1.0})), false);
      const auto fitted = lens.find({ghost.ghost, light, kPlane_mm, kSmaller * fit->stop_radius_mm, 400.0, 700.0});
      REQUIRE(fitted != nullptr);
      CHECK(!fitted->is_symmetric());
      const auto source = fitted->at(kLambda_nm);
      const Rectangle box = fitted->region();
      std::vector<float> x_mm, y_mm;
      for (int k = 0; k < 61; ++k) {
        x_mm.push_back(static_cast<float>((box.high.x - box.low.x) * k / 60.0));
        y_mm.push_back(static_cast<float>((box.high.y - box.low.y) * (0.5 + 0.5 * std::sin(0.7 * k))));
      }
      std::vector<float> sensor_x(61), sensor_y(61), transmission(61), height(61), stop_x(61), stop_y(61),
          rims(61 * std::max<std::size_t>(source->rims(), 1));
      TracedArrays out{sensor_x.data(), sensor_y.data(), transmission.data(), height.data(), {}, {}, rims.data(), 61};
      out.stop_x[0] = stop_x.data(), out.stop_y[0] = stop_y.data();
      source->rays(box.low, PacketPrecision::Float, x_mm.data(), y_mm.data(), 61, out);
      for (std::size_t k = 0; k < 61; ++k) {
        const Vec2 at = box.low + Vec2{x_mm[k], y_mm[k]} + tangents * (fit->entrance_z_mm - kPlane_mm);
        const auto ray = evaluate(*fit, ghost, tangents, at, kLambda_nm);
        REQUIRE(ray.has_value());
        if (std::max(ray->relative_height, length(ray->stop[0])) > 1.1) continue;
        CHECK(length(Vec2{sensor_x[k], sensor_y[k]} - ray->sensor_mm) < 0.03 * fit->pixel_mm);
        CHECK(length(Vec2{stop_x[k], stop_y[k]} * kSmaller - ray->stop[0]) < 1e-4);
        CHECK(std::abs(height[k] - std::max(ray->relative_height, length(ray->stop[0]) / 1.03)) < 3e-4);
        ++compared;
      }
    }
    CHECK(compared > 30);
  }
}

TEST_CASE("files of ghosts without axial symmetry are read as written, and refused where they are damaged") {
  const std::string bytes = write_polynomials(triplet_fit());
  const auto read = read_polynomials(bytes, "a.poly");
  REQUIRE(read.has_value());
  CHECK(write_polynomials(*read) == bytes);
  for (std::size_t size = 0; size < bytes.size(); size += 1 + bytes.size() / 300)
    CHECK(!read_polynomials(std::string_view(bytes).substr(0, size), "a.poly").has_value());
  const AsymmetricZone& zone = *fitted_zone(read->ghosts.front());
  std::mt19937 random(11);
  for (int k = 0; k < 300; ++k) {
    std::string damaged = bytes;
    for (int flips = 0; flips < 3; ++flips) damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
    const auto hostile = read_polynomials(damaged, "a.poly");
    if (!hostile || hostile->ghosts.empty()) continue;
    const auto ray =
        evaluate(*hostile, hostile->ghosts.front(), polynomial::tangents_at(zone, {0.2, 0.3}), {0.1, 0.2}, 550.0);
    if (ray) CHECK(!std::isnan(ray->transmittance));
  }
}

TEST_CASE("a file whose zone is even without a mirror plane is refused") {
  LensPolynomials fit = triplet_fit();
  for (AsymmetricZone& zone : fit.ghosts.front().asymmetric) zone.even_y = true;
  CHECK(!read_polynomials(write_polynomials(fit), "a.poly").has_value());
}

TEST_CASE("zones cover the field, and light outside is left to the tracer") {
  const GhostPolynomials& ghost = triplet_fit().ghosts.front();
  const AsymmetricZone& zone = *fitted_zone(ghost);
  CHECK(find_zone(ghost, Vec2{0.9 * zone.high.x, 0.9 * zone.low.y}).zone != nullptr);
  CHECK(find_zone(ghost, Vec2{5.0, 0.0}).zone == nullptr);
  CHECK(!evaluate(triplet_fit(), ghost, Vec2{5.0, 0.0}, {0.0, 0.0}, 550.0).has_value());
}
