// SPDX-License-Identifier: Apache-2.0
// The exit pupil in direction cosines, against first-order optics, the ghosts' own flux measure and rays traced
// densely.
#include <cmath>
#include <iterator>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/first_order.h"
#include "contrejour/expert/ghost.h"
#include "contrejour/expert/lens_starburst.h"
#include "support/approx.h"
#include "support/pictures.h"
#include "support/scenes.h"

using namespace contrejour;

namespace {

struct Case {
  const char* lens;
  LensSettings settings;
  double azimuth_deg, elevation_deg;
};

const Case kCases[] = {
    {"heliar", {.f_number = 16.0}, 0.0, 0.0},
    {"heliar", {.f_number = 4.5}, 14.0, 9.0},
    {"canon-70-200", {.focal_length_mm = 135.0, .f_number = 2.8, .iris = {8, 0.2}}, 6.0, -4.0},
    {"canon-70-200", {.focal_length_mm = 70.0, .f_number = 5.6, .iris = {5, 0.3}}, -12.0, 8.0},
    {"nikon-80-200", {.f_number = 2.8}, 9.0, 5.0},
    {"nakamura-22", {.f_number = 4.0, .iris = {7, 0.1}}, 20.0, 12.0},
};

Vec3 direction_of(const Case& c) {
  constexpr double kDegree_rad = 0.017453292519943295;
  return direction_from_angles(c.azimuth_deg * kDegree_rad, c.elevation_deg * kDegree_rad);
}

}  // namespace

TEST_CASE("on the axis the exit pupil is first-order optics'") {
  for (const char* name : {"heliar", "canon-70-200", "nakamura-22"}) {
    CAPTURE(name);
    const LensState lens = test::bundled(name, {.f_number = 22.0});
    const FirstOrder first = first_order(lens, lens.design_wavelength_nm);
    const auto pupil = exit_pupil(lens, Vec3{0, 0, 1}, lens.design_wavelength_nm);
    REQUIRE(pupil.has_value());
    // As seen from 1 mm instead of its real distance.
    const double radius = 0.5 * first.exit_pupil_diameter_mm / std::abs(first.exit_pupil_position_mm);
    CHECK(length(pupil->outline.value().x_mm) / radius == test::approx(1.0).epsilon(2e-3));
    CHECK(length(pupil->outline.value().y_mm) / radius == test::approx(1.0).epsilon(2e-3));
    CHECK(length(pupil->middle) < 1e-2 * radius);
  }
}

TEST_CASE("borders are where traced rays are blocked, and the flux is the direct image's [slow]") {
  std::vector<Case> cases(std::begin(kCases), std::end(kCases));
  cases.push_back({"heliar", {.f_number = 5.6, .iris = {5, 0.3, 0.5, 1.0, 0.1, 1}}, 10.0, 4.0});
  cases.push_back({"heliar", {.f_number = 5.6}, 10.0, 4.0});
  cases.back().settings.iris.rotation_rad = 0.4;
  cases.back().settings.iris.field = test::flower_field();
  cases.push_back({"heliar", {.f_number = 5.6}, 8.0, 5.0});
  const std::size_t obscured = cases.size() - 1;
  for (const Case& c : cases) {
    CAPTURE(c.lens);
    CAPTURE(c.azimuth_deg);
    LensState lens = test::bundled(c.lens, c.settings);
    if (&c == &cases[obscured]) {
      lens.surfaces.front().obscuration = {{4.0, 3.0}, {0.5, 0.0}, 0.3};
      lens.surfaces[static_cast<std::size_t>(lens.stop_index)].obscuration = {{1.5, 1.5}, {2.0, 1.0}, 0.0};
    }
    const double sample = &c == &cases[obscured] ? 3e-2 : 6e-3;  // its diagonal, over the smallest radius
    const Vec3 direction = direction_of(c);
    const double lambda_nm = lens.design_wavelength_nm;
    const auto pupil = exit_pupil(lens, direction, lambda_nm);
    REQUIRE(pupil.has_value());
    REQUIRE(pupil->radius > 0.0);
    CHECK(pupil->fit_error < 1e-3);
    CHECK(pupil->flux_mm2 / GhostMeter(lens, lambda_nm).direct_flux(direction) == test::approx(1.0).epsilon(2e-3));

    // Compares each traced ray with the sample it falls on, unless a border is closer than a sample.
    const OpticalPath path = direct_path(lens, lambda_nm);
    const EntranceWindow window = entrance_window(lens, direction);
    int wrong = 0, open = 0;
    for (int y = 0; y < 300; ++y) {
      for (int x = 0; x < 300; ++x) {
        const Vec2 at{window.min_mm.x + (x + 0.5) / 300 * (window.max_mm.x - window.min_mm.x),
                      window.min_mm.y + (y + 0.5) / 300 * (window.max_mm.y - window.min_mm.y)};
        const TracedRay ray = trace(path, {{at.x, at.y, window.z_mm}, direction});
        if (ray.status != RayStatus::Ok) continue;
        const double blocked = blocked_by(ray, path, lens.iris);
        const bool is_folded =
            std::max(blocked, ray.relative_height - 1.0) > 0.25 && ray.obscured <= 0.0;  // and refracted back
        if (std::abs(blocked) < sample || is_folded) continue;
        const Vec2 p = (Vec2{ray.direction.x, ray.direction.y} - pupil->middle) * (1.0 / pupil->mask.grid.pitch_mm);
        const int column = static_cast<int>(std::floor(p.x + 0.5 * pupil->mask.grid.side));
        const int row = static_cast<int>(std::floor(0.5 * pupil->mask.grid.side - p.y));
        const bool inside = column >= 0 && row >= 0 && column < pupil->mask.grid.side && row < pupil->mask.grid.side;
        const bool lit =
            inside && pupil->mask.amplitude[static_cast<std::size_t>(row * pupil->mask.grid.side + column)] > 0.4F;
        wrong += lit != (blocked < 0.0);
        open += blocked < 0.0;
      }
    }
    CHECK(open > 0);
    CHECK(wrong == 0);
  }
}

TEST_CASE(
    "every bundled lens wide open, from the axis to the corner: flux, outline, and rays the fit did not see [slow]") {
  int without_outline = 0;  // the fisheye's corner, a sliver
  for (const BundledLens& entry : bundled_lenses()) {
    const std::string name(entry.name);
    CAPTURE(name);
    const LensState lens = test::bundled(name.c_str());
    const GhostMeter meter(lens, lens.design_wavelength_nm);
    for (const double field : {0.0, 0.4, 0.7, 0.98}) {
      CAPTURE(field);
      const Vec2 corner_mm{0.5 * lens.sensor_width_mm, 0.5 * lens.sensor_height_mm};
      const Vec3 direction = direction_for_image_point(lens, corner_mm * field, lens.design_wavelength_nm);
      const auto pupil = exit_pupil(lens, direction, lens.design_wavelength_nm);
      REQUIRE(pupil.has_value());
      const double flux_mm2 = meter.direct_flux(direction);
      if (flux_mm2 <= 0.0) continue;
      REQUIRE(pupil->radius > 0.0);
      CHECK(pupil->flux_mm2 / flux_mm2 == test::approx(1.0).epsilon(5e-3));
      CHECK(pupil->fit_error < 4e-3);
      double open = 0.0;
      for (const float a : pupil->mask.amplitude) open += a > 0.0F ? 1.0 : 0.0;
      open *= pupil->mask.grid.pitch_mm * pupil->mask.grid.pitch_mm;
      without_outline += !pupil->outline.has_value();
      if (pupil->outline) CHECK(pupil->outline->area_mm2() / open == test::approx(1.0).epsilon(0.06));
    }
  }
  CHECK(without_outline <= 1);
}

TEST_CASE("no light gets through: an empty pupil and a starburst that draws nothing; bad input is refused") {
  const LensState lens = test::bundled("heliar", {.f_number = 8.0});
  const Vec3 beside = normalized(Vec3{1.0, 0.0, 0.05});
  const auto pupil = exit_pupil(lens, beside, 550.0);
  REQUIRE(pupil.has_value());
  CHECK(pupil->radius == 0.0);
  const auto bands = spectral_bands(120, IlluminantD65{}, ColourSpace::Rec709);
  CHECK(lens_starburst(lens, beside, bands, {}).value().rings() == nullptr);
  CHECK_FALSE(exit_pupil(lens, Vec3{0, 0, -1}, 550.0).has_value());
  CHECK_FALSE(exit_pupil(lens, Vec3{0, std::nan(""), 1}, 550.0).has_value());
  CHECK_FALSE(exit_pupil(lens, Vec3{0, 0, 1}, 0.0).has_value());
  CHECK_FALSE(exit_pupil(lens, Vec3{0, 0, 1}, 550.0, 1).has_value());
  CHECK_FALSE(lens_starburst(lens, Vec3{0, 0, 1}, {}, {}).has_value());
  CHECK_FALSE(lens_starburst(lens, Vec3{0, 0, 1}, bands, {.pixel_pitch_mm = 0.0}).has_value());
}
