// SPDX-License-Identifier: Apache-2.0
// The drawn section: its shapes as data, and the SVG that earlier releases wrote.
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>

#include "contrejour/expert/check_lens.h"
#include "contrejour/expert/lens_section.h"
#include "support/approx.h"

using namespace contrejour;

namespace {

LensState bundled_state(const char* name) { return configure_lens(find_lens(name).value()).value(); }

std::string stored(const std::string& name) {
  std::ifstream file(std::string(CONTREJOUR_DRAWINGS) + "/" + name, std::ios::binary);
  REQUIRE(file.good());
  return {std::istreambuf_iterator<char>(file), {}};
}

SectionRequest at_design_wavelength(const LensState& lens) {
  SectionRequest request;
  request.lambda_nm = lens.design_wavelength_nm;
  return request;
}

}  // namespace

TEST_CASE("lens section: the drawings of earlier releases, byte for byte") {
  const LensState heliar = bundled_state("heliar");
  CHECK(section_svg(lens_section(heliar, at_design_wavelength(heliar))) == stored("heliar.svg"));
  const LensState aspheres = bundled_state("canon-rf-50");
  SectionRequest request = at_design_wavelength(aspheres);
  request.ghosts = {{.i = 2, .j = 5}};
  request.ghost_light_rad = 4.0 * std::numbers::pi / 180.0;
  CHECK(section_svg(lens_section(aspheres, request)) == stored("canon-rf-50-ghost.svg"));
}

TEST_CASE("lens section: an arc's points lie on its sphere, no further from it than the tolerance") {
  for (const char* const name : {"heliar", "muller-fisheye-10"}) {
    const LensState lens = bundled_state(name);
    const LensSection section = lens_section(lens);
    REQUIRE(section.surfaces.size() + 1 == lens.surfaces.size());
    for (const SectionSurface& drawn : section.surfaces) {
      CAPTURE(drawn.surface);
      const SurfaceState& s = section.lens.surfaces[drawn.surface];
      const std::vector<Vec2> points = polyline(drawn.curve, 0.01);
      CHECK(points.front().y == -points.back().y);
      CHECK(points.front().y > 0.0);
      if (s.curvature_per_mm == 0.0) continue;
      const double radius = 1.0 / s.curvature_per_mm;
      for (std::size_t k = 0; k < points.size(); ++k) {
        CHECK(std::hypot(points[k].x - s.z_mm - radius, points[k].y) == test::approx(std::abs(radius)).epsilon(1e-9));
        if (k == 0) continue;
        CHECK(points[k].y < points[k - 1].y);
        const Vec2 middle = (points[k] + points[k - 1]) * 0.5;
        CHECK(std::abs(radius) - std::hypot(middle.x - s.z_mm - radius, middle.y) <= 0.01 + 1e-9);
      }
    }
  }
}

TEST_CASE("lens section: elements are closed, rays end on the sensor, the stop and the sensor are where they are") {
  const LensState lens = bundled_state("heliar");
  const LensSection section = lens_section(lens);
  REQUIRE(section.elements.size() == 5);
  for (const SectionElement& element : section.elements) {
    CHECK(element.outline.pieces.back().to_mm == element.outline.from_mm);
    CHECK(element.index_d > 1.4);
  }
  CHECK(section.stop.opening_mm == lens.stop_radius_mm);
  CHECK(section.sensor.z_mm == lens.sensor_z_mm);
  REQUIRE(section.rays.size() == 10);
  for (const SectionRay& ray : section.rays) {
    CHECK(!ray.blocked);
    CHECK(ray.points_mm.front().x == test::approx(section.left_mm));
    CHECK(ray.points_mm.back().x == lens.sensor_z_mm);
  }
  // The rays from the axis meet in a point, but for spherical aberration.
  for (const SectionRay& ray : section.rays)
    if (ray.kind == SectionRayKind::Axis) CHECK(std::abs(ray.points_mm.back().y) < 0.3);
}

TEST_CASE("lens section: ghosts that a lens does not have get no rays, a state without surfaces no shapes") {
  SectionRequest request;
  request.ghosts = {{.i = 2, .j = 90}};
  const LensSection section = lens_section(bundled_state("heliar"), request);
  for (const SectionRay& ray : section.rays) CHECK(ray.kind != SectionRayKind::Ghost);
  const LensSection empty = lens_section(LensState{});
  CHECK(empty.rays.empty());
  CHECK(section_svg(empty).find("nan") == std::string::npos);
}
