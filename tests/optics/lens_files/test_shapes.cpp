// SPDX-License-Identifier: Apache-2.0
// Shapes and positions of surfaces in the lens format.
#include <cmath>

#include <doctest/doctest.h>

#include "contrejour/lens.h"

namespace contrejour::test::shapes {
namespace {

std::string lens_with(const std::string& row, const std::string& more = "") {
  return "name = \"a\"\nsource = \"b\"\nf_number = 8\nsensor_mm = [36, 24]\nsurfaces = [\n  { radius_mm = 50, "
         "thickness_mm = 5, "
         "semi_diameter_mm = 8, glass = { n = 1.5 }" +
         row +
         " },\n  { radius_mm = -60, thickness_mm = 4, semi_diameter_mm = 8 },\n"
         "  { stop = true, thickness_mm = 3, semi_diameter_mm = 6 },\n  { radius_mm = inf, thickness_mm = 2, "
         "semi_diameter_mm = 7, glass = { n = 1.6 } },\n  { radius_mm = -80, semi_diameter_mm = 7 },\n]\n" +
         more;
}

Surface read(const std::string& row) {
  const auto lens = read_lens_toml(lens_with(row), "x.toml");
  if (!lens) FAIL(lens.error().to_string());
  return lens->surfaces.front();
}

void check_refused(const std::string& row, int line, const std::string& why, const std::string& more = "") {
  const auto lens = read_lens_toml(lens_with(row, more), "x.toml");
  CAPTURE(row + more);
  REQUIRE_FALSE(lens.has_value());
  CHECK(lens.error().position.line == line);
  CHECK_MESSAGE(lens.error().message.find(why) != std::string::npos, lens.error().message);
}

TEST_CASE("a row's conic, asphere, toroid, biconic and pose") {
  CHECK(read("").shape == SurfaceShape{});
  CHECK(read(", conic = -1.5").shape == SurfaceShape{.conic = -1.5});
  CHECK(read(", asphere = { 4 = 1e-5, 2 = 3e-4, 10 = 1e-14 }").shape.powers ==
        std::vector<double>{0, 3e-4, 0, 1e-5, 0, 0, 0, 0, 0, 1e-14});
  CHECK(read(", toroid = { radius_x_mm = inf }").shape == SurfaceShape{.kind = ShapeKind::Toroid});
  CHECK(read(", conic = 1, biconic = { radius_x_mm = 40, conic_x = -2, turn_deg = 90 }").shape ==
        SurfaceShape{.kind = ShapeKind::Biconic,
                     .conic = 1,
                     .curvature_x_per_mm = 1.0 / 40,
                     .conic_x = -2,
                     .rotation_rad = std::acos(0.0)});
  const SurfacePose pose = read(", decentre_mm = [0.1, -0.2], tilt_deg = [2, 3]").pose;
  CHECK(pose.shift_mm == Vec3{0.1, -0.2, 0.0});
  const double a = 2 * std::acos(-1.0) / 180, b = 3 * std::acos(-1.0) / 180;
  CHECK(length(pose.axis - Vec3{std::sin(b) * std::cos(a), -std::sin(a), std::cos(a) * std::cos(b)}) < 1e-15);
  CHECK(length(read(", axis = [0, 3, 4.0e1]").pose.axis - normalized({0, 3, 40})) < 1e-15);
}

TEST_CASE("a row's rim and what stands before its middle, the stop's too; written and read again the same") {
  CHECK(read(", ellipse = { semi_axes_mm = [5, 3], centre_mm = [0.5, 1] }").aperture ==
        ClearAperture{ApertureKind::Ellipse, {5, 3}, {0.5, 1}, 0.0});
  CHECK_FALSE(read("").obscuration.any());
  CHECK(read(", obscuration = { semi_axes_mm = [3, 3] }").obscuration == Obscuration{{3, 3}, {}, 0.0});
  const Surface askew = read(", obscuration = { semi_axes_mm = [3, 2], centre_mm = [0.1, -0.2], turn_rad = 0.4 }");
  CHECK(askew.obscuration == Obscuration{{3, 2}, {0.1, -0.2}, 0.4});
  std::string text = lens_with(", obscuration = { semi_axes_mm = [3, 2], centre_mm = [0.1, -0.2], turn_rad = 0.4 }");
  const std::string stop = "semi_diameter_mm = 6";
  text.replace(text.find(stop), stop.size(), stop + ", obscuration = { semi_axes_mm = [1, 1] }");
  const auto lens = read_lens_toml(text, "x.toml");
  REQUIRE(lens.has_value());
  CHECK(lens->surfaces[2].obscuration == Obscuration{{1, 1}, {}, 0.0});
  const auto state = configure_lens(*lens);
  REQUIRE(state.has_value());
  CHECK(state->surfaces[0].obscuration == askew.obscuration);
  CHECK(state->surfaces[2].obscuration == lens->surfaces[2].obscuration);
  const auto again = read_lens_toml(write_lens_toml(*lens), "x.toml");
  REQUIRE(again.has_value());
  for (std::size_t k = 0; k < lens->surfaces.size(); ++k)
    CHECK(again->surfaces[k].obscuration == lens->surfaces[k].obscuration);

  check_refused(", obscuration = { }", 6, "give semi_axes_mm");
  check_refused(", obscuration = { semi_axes_mm = [0, 1] }", 6, "half sides of more than 0");
  check_refused(", obscuration = { semi_axes_mm = [2, 2], centre_mm = [0, 9] }", 6, "within semi_diameter_mm");
  check_refused(", obscuration = { semi_axes_mm = [9, 8.5], centre_mm = [0.2, 0] }", 6, "covers all of the surface");
}

TEST_CASE("a group is carried as one body, about its middle") {
  const auto lens = read_lens_toml(
      lens_with("", "groups = [{ surfaces = [1, 2], decentre_mm = [0.1, 0], tilt_deg = [1, 0] }]\n"), "x.toml");
  REQUIRE(lens.has_value());
  const SurfacePose front = lens->surfaces[0].pose, rear = lens->surfaces[1].pose;
  const Vec3 between = rear.shift_mm + Vec3{0, 0, 5} - front.shift_mm;
  CHECK(length(between - front.axis * 5.0) < 1e-14);  // the vertices stay on the common axis
  CHECK(front.axis == rear.axis);
  CHECK(length((front.shift_mm + rear.shift_mm) * 0.5 - Vec3{0.1, 0, 0}) < 1e-12);
  CHECK(lens->surfaces[3].pose == SurfacePose{});
  const auto state = configure_lens(*lens);
  REQUIRE(state.has_value());
  CHECK_FALSE(state->has_axial_symmetry());
  CHECK(state->surfaces[1].pose == rear);
  // Build errors are added.
  const auto worse = configure_lens(*lens, {.build = {0.001, 0.05, 1}});
  REQUIRE(worse.has_value());
  CHECK(length(worse->surfaces[1].pose.axis - rear.axis) > 1e-5);
  CHECK(length(worse->surfaces[1].pose.axis - rear.axis) < 0.01);
}

TEST_CASE("what is wrong with a shape is said with its line") {
  check_refused(", asphere = { 21 = 1 }", 6, "no power '21'");
  check_refused(", asphere = { a4 = 1 }", 6, "no power 'a4'");
  check_refused(", asphere = { 4 = nan }", 6, "coefficient is nan");
  check_refused(", conic = \"x\"", 6, "conic must be a number");
  check_refused(", conic = 1e8", 6, "conic constant is 100000000");
  check_refused(", conic = 50", 6, "the surface ends before semi_diameter_mm 8");
  check_refused(", toroid = {}", 6, "give either radius_x_mm (inf for a plane) or curvature_x_per_mm");
  check_refused(", toroid = { radius_x_mm = 5 }", 6, "the surface ends before");
  check_refused(", toroid = { radius_x_mm = 1e-8 }", 6, "a radius is less than 1e-06 mm");
  check_refused(", toroid = { radius_x_mm = 50, conic_x = 1 }", 6, "unknown key 'conic_x'");
  check_refused(", biconic = { radius_x_mm = 50 }, asphere = { 4 = 1e-6 }", 6, "a biconic has no asphere");
  check_refused(", biconic = { radius_x_mm = 50 }, toroid = { radius_x_mm = 50 }", 6, "not both");
  check_refused(", decentre_mm = [1]", 6, "decentre_mm must be a list of 2 or 3 numbers");
  check_refused(", tilt_deg = [80, 0]", 6, "tilt it by 60 degrees at most");
  check_refused(", axis = [0, 0, 0]", 6, "axis has no direction");
  check_refused(", axis = [0, 0, 1], tilt_deg = [1, 1]", 6, "either tilt_deg or axis");
  check_refused(", asphere = { 4 = 4e-3 }", 7, "it crosses surface 1");
  check_refused("", 12, "group 1: the last surface is 9", "groups = [{ surfaces = [1, 9], decentre_mm = [1, 0] }]");
  check_refused("", 12, "group 1: unknown key 'tilt'", "groups = [{ surfaces = [1, 2], tilt = [1, 0] }]");
  Prescription lens = *read_lens_toml(lens_with(""), "x.toml");
  for (const SurfaceShape& wrong : {SurfaceShape{.powers = std::vector<double>(21, 1e-30)},
                                    {.curvature_x_per_mm = 1.0},
                                    {.kind = ShapeKind::Toroid, .conic_x = 1.0},
                                    {.powers = {std::nan("")}}}) {
    lens.surfaces[0].shape = wrong;
    CHECK_FALSE(validate(lens).has_value());
  }
  lens.surfaces[0].shape = {};
  lens.surfaces[2].pose.shift_mm.x = 0.1;
  CHECK_FALSE(validate(lens).has_value());  // a stop
}

}  // namespace
}  // namespace contrejour::test::shapes
