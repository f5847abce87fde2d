// SPDX-License-Identifier: Apache-2.0
// Where a ghost's light enters: half of a grid compared with a whole one.
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include <doctest/doctest.h>

#include "render/pupils/open_polygon.h"
#include "render/pupils/pupil_shape.h"
#include "support/approx.h"
#include "support/scenes.h"

using namespace contrejour;
using namespace contrejour::pupils;

namespace {

double apart(const LinearMap& a, const LinearMap& b) {
  const LinearMap off = a - b;
  return std::sqrt((dot(off.x, off.x) + dot(off.y, off.y)) / (dot(b.x, b.x) + dot(b.y, b.y)));
}

}  // namespace

TEST_CASE("in a light's own frame, by half of the rays, a pupil is where it is in the lens's") {
  const LensState lens = test::bundled("heliar", {.f_number = 8.0});
  const ReflectanceTables tables(lens, 550.0);
  const LensSteps steps(lens, tables);
  int found = 0, whole = 0;
  for (const double rotation : {0.0, 0.4, 2.5, -1.2}) {
    const double tangent = 0.12;
    const LightSource source{normalized(Vec3{tangent * std::cos(rotation), tangent * std::sin(rotation), 1.0})};
    const EntranceWindow window = entrance_window(lens, source);
    for (const Ghost& ghost : enumerate_ghosts(lens, GhostScope::OneSideOfStop)) {
      CAPTURE(rotation);
      CAPTURE(ghost.i);
      CAPTURE(ghost.j);
      const auto half = find_pupil_shape(steps, ghost, LightFrame(source, true), window);
      const auto all = find_pupil_shape(steps, ghost, LightFrame(source, false), window);
      REQUIRE(half.has_value() == all.has_value());
      if (!half || !half->is_open || !all->is_open) continue;
      ++found;
      whole += half->bound_fractions[0] > 0.85 && all->bound_fractions[0] > 0.85 ? 1 : 0;
      const double radius_mm = 2.0 * std::sqrt(0.5 * trace_of(all->covariance));
      CHECK(length(half->middle_mm - all->middle_mm) < 0.6 * radius_mm);
      CHECK(apart(half->covariance, all->covariance) < 0.25);
      CHECK(half->area_mm2 == test::approx(all->area_mm2).epsilon(0.25));
      CHECK(half->border_mm == test::approx(all->border_mm).epsilon(0.4));
      CHECK_FALSE(half->border.empty());
      for (const BorderPoint& point : half->border) CHECK(length(point.start_mm - all->middle_mm) < 3.0 * radius_mm);
    }
  }
  CHECK(found > 30);
  CHECK(whole > 10);
}

TEST_CASE("a pupil changes steadily with the light, however the grid's rays lie") {
  const LensState lens = test::bundled("heliar", {.f_number = 8.0});
  const ReflectanceTables tables(lens, 550.0);
  const LensSteps steps(lens, tables);
  constexpr double kStep = 2e-4;  // tangent: about a tenth of a pixel
  constexpr int kLights = 8;
  int checked = 0;
  for (const Ghost& ghost : enumerate_ghosts(lens, GhostScope::OneSideOfStop)) {
    std::vector<PupilShape> shapes;
    for (int k = 0; k < kLights; ++k) {
      const LightSource source{normalized(Vec3{0.11 + k * kStep, 0.04, 1.0})};
      const auto shape = find_pupil_shape(steps, ghost, LightFrame(source, true), entrance_window(lens, source));
      if (shape && shape->is_open) shapes.push_back(*shape);
    }
    if (shapes.size() < kLights) continue;
    CAPTURE(ghost.i);
    CAPTURE(ghost.j);
    for (std::size_t k = 2; k < shapes.size(); ++k) {
      const PupilShape &a = shapes[k - 2], &b = shapes[k - 1], &c = shapes[k];
      const double radius_mm = std::sqrt(trace_of(b.covariance));
      CHECK(std::abs(a.area_mm2 - 2.0 * b.area_mm2 + c.area_mm2) < 0.01 * b.area_mm2);
      CHECK(length(a.middle_mm - b.middle_mm * 2.0 + c.middle_mm) < 0.01 * radius_mm);
      CHECK(apart(a.covariance + c.covariance, b.covariance * 2.0) < 0.01);
      ++checked;
    }
  }
  CHECK(checked > 50);
}

TEST_CASE("a pupil that is narrow or small keeps its extent while its light moves") {
  struct Case {
    Ghost ghost;
    int first, end;  // times; the light moves by a tenth of a pixel of 160 x 90 each
  };
  // The box of a coarse grid cut off the ends of the first one's two thin parts in some frames, up to a third, and the
  // box of a search a sixth of the second one.
  for (const Case& one : {Case{{9, 22}, 70, 90}, Case{{4, 13}, 165, 185}}) {
    CAPTURE(one.ghost.i);
    const LensState lens = test::bundled("canon-70-200", {.focal_length_mm = 135.0, .f_number = 32.0});
    const ReflectanceTables tables(lens, 530.0);
    const LensSteps steps(lens, tables);
    const Frame frame = frame_on_sensor(lens, 160, 90);
    std::optional<PupilShape> last;
    for (int k = one.first; k < one.end; ++k) {
      CAPTURE(k);
      const Light light =
          test::light_at(lens, frame, {0.70 + 0.1 * k * std::cos(0.3) / 160, 0.33 + 0.1 * k * std::sin(0.3) / 90});
      const LightSource source{light.direction};
      const auto shape = find_pupil_shape(steps, one.ghost, LightFrame(source, true), entrance_window(lens, source));
      REQUIRE(shape);
      REQUIRE(shape->is_open);
      if (last) {
        CHECK(apart(shape->covariance, last->covariance) < 0.06);
        CHECK(shape->area_mm2 == test::approx(last->area_mm2).epsilon(0.04));
      }
      last = shape;
    }
  }
}

TEST_CASE("the open part of a triangle has the moments of its polygon") {
  // x + y <= 0.5 of the half square: a triangle a quarter as large.
  const OpenPolygon open = open_polygon({Vec2{0.0, 0.0}, Vec2{1.0, 0.0}, Vec2{0.0, 1.0}}, {-0.5, 0.5, 0.5});
  CHECK(open.moments.area_mm2 == test::approx(0.125));
  CHECK(open.moments.centroid().x == test::approx(0.5 / 3.0));
  CHECK(open.moments.covariance().x.x == test::approx(0.25 / 18.0));
  CHECK(open.moments.covariance().x.y == test::approx(-0.25 / 36.0));
  REQUIRE(open.has_border);
  CHECK(length(open.border[1] - open.border[0]) == test::approx(std::sqrt(0.5)));
  const OpenPolygon rest = open_polygon({Vec2{0.0, 0.0}, Vec2{1.0, 0.0}, Vec2{0.0, 1.0}}, {0.5, -0.5, -0.5});
  CHECK(rest.moments.area_mm2 == test::approx(0.375));
  CHECK(open_polygon({}, {1.0, 1.0, 1.0}).moments.area_mm2 == 0.0);
}

TEST_CASE("a pupil smaller than the first grid's cells is found, whatever small opening lies nearer to a ray") {
  const LensState lens = test::bundled("nikon-80-200", {.focal_length_mm = 140.0, .f_number = 16.0});
  const ReflectanceTables tables(lens, 550.0);
  const LensSteps steps(lens, tables);
  const double width_mm = lens.sensor_width_mm, height_mm = width_mm * 9.0 / 16.0;
  for (const double tenths_px : {0.0, 11.0, 12.0, 13.0, 14.0}) {  // of a frame of 160 x 90 pixels
    const double moved_mm = 0.1 * tenths_px * width_mm / 160.0;
    const Vec2 at_mm{0.2 * width_mm + moved_mm * std::cos(0.3), 0.17 * height_mm - moved_mm * std::sin(0.3)};
    const LightSource source{direction_for_image_point(lens, at_mm, lens.design_wavelength_nm)};
    const auto shape = find_pupil_shape(steps, {6, 9}, LightFrame(source, true), entrance_window(lens, source));
    CAPTURE(tenths_px);
    REQUIRE(shape.has_value());
    CHECK(shape->area_mm2 == test::approx(30.8).epsilon(0.01));
  }
}

TEST_CASE("a border belongs to what bounds the light there, not to what blocks the next ray of the grid most") {
  const LensState lens = test::bundled("heliar", {.f_number = 16.0});
  const ReflectanceTables tables(lens, 550.0);
  const LensSteps steps(lens, tables);
  const double px_mm = lens.sensor_width_mm / 160.0;
  std::vector<PupilShape> shapes;
  for (int tenths_px = 16; tenths_px < 28; ++tenths_px) {
    const double moved_mm = 0.1 * tenths_px * px_mm;
    const Vec2 at_mm{32.0 * px_mm + moved_mm * std::cos(0.3), 15.3 * px_mm - moved_mm * std::sin(0.3)};
    const LightSource source{direction_for_image_point(lens, at_mm, lens.design_wavelength_nm)};
    const auto shape = find_pupil_shape(steps, {1, 7}, LightFrame(source, true), entrance_window(lens, source));
    REQUIRE((shape.has_value() && shape->is_open));
    shapes.push_back(*shape);
  }
  // The first and the third crossing of the stop bound a side of this ghost nearly alike.
  for (std::size_t k = 1; k < shapes.size(); ++k)
    for (std::size_t bound = 0; bound <= kRims; ++bound)
      CHECK(std::abs(shapes[k].bound_fractions[bound] - shapes[k - 1].bound_fractions[bound]) < 0.02);
}
