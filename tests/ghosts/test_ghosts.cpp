#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include "contrejour/ghost.h"
#include "ghosts/pupil_search.h"
#include "support/scenes.h"

using namespace contrejour;
using test::bundled;

namespace {

constexpr double kGreen_nm = 550.0;

}  // namespace

TEST_CASE("the papers' ghost counts: 13, 73, 142 and 312 with both reflections on one side of the stop") {
  const auto count = [](const char* name, GhostScope scope) {
    return enumerate_ghosts(bundled(name, {}), scope).size();
  };
  CHECK(count("heliar", GhostScope::OneSideOfStop) == 13);
  CHECK(count("itoh-zoom", GhostScope::OneSideOfStop) == 73);
  CHECK(count("nikon-80-200", GhostScope::OneSideOfStop) == 142);
  CHECK(count("canon-70-200", GhostScope::OneSideOfStop) == 312);
  CHECK(count("heliar", GhostScope::All) == 8 * 7 / 2);
  CHECK(count("canon-70-200", GhostScope::All) == 33 * 32 / 2);
}

TEST_CASE("openings in air reflect nothing; a film between the same media does") {
  LensState lens = bundled("heliar", {});
  SurfaceState opening = lens.surfaces.front();
  opening.after = opening.before;
  opening.z_mm -= 5.0;
  lens.surfaces.insert(lens.surfaces.begin(), opening);
  ++lens.stop_index;
  lens.surfaces.front().coating = {};
  CHECK(enumerate_ghosts(lens, GhostScope::All).size() == 8 * 7 / 2);
  for (const Ghost& ghost : enumerate_ghosts(lens, GhostScope::All)) CHECK(ghost.i > 1);
  lens.surfaces.front().coating = {"", FilmStack{{{2.0, 60.0}}}};
  CHECK(enumerate_ghosts(lens, GhostScope::All).size() == 9 * 8 / 2);
}

TEST_CASE("a plate's ghost carries area cos(theta) T R R T, and lands as the stop's own disc") {
  const LensState lens = test::plate();
  for (const double angle : {0.0, 0.3}) {
    const Vec3 d{std::sin(angle), 0.0, std::cos(angle)};
    const double r = reflectance({}, 1.0, 1.5, std::cos(angle), kGreen_nm);
    const double area = std::numbers::pi * 9.0 * std::cos(angle);
    const GhostMeter meter(lens, kGreen_nm);
    const GhostMeasure m = meter.measure({2, 3}, d);
    CHECK(m.flux_mm2 / (area * (1 - r) * r * r * (1 - r)) == doctest::Approx(1.0).epsilon(1e-3));
    CHECK(m.max_mm.x - m.min_mm.x == doctest::Approx(6.0).epsilon(0.05));
    CHECK(m.peak_per_mm2 / (std::cos(angle) * (1 - r) * r * r * (1 - r)) == doctest::Approx(1.0).epsilon(1e-3));
    CHECK(meter.direct_flux(d) == doctest::Approx(area * (1 - r) * (1 - r)).epsilon(3e-4));
  }
}

TEST_CASE("a near light's direct flux is the solid angle that the stop fills, seen from there") {
  Prescription hole;  // no glass: all of it passes
  hole.surfaces = {{SurfaceKind::Stop, 0.0, 1.0, 20.0, air(), {}, 0},
                   {SurfaceKind::Refracting, 0.0, 2.0, 60.0, air(), {}, 0},
                   {SurfaceKind::Refracting, 0.0, 0.0, 60.0, air(), {}, 0}};
  LensState lens = test::place(hole, 3.0);
  lens.sensor_z_mm = 10.0;
  lens.focal_length_mm = 50.0;
  const GhostMeter meter(lens, kGreen_nm);
  for (const double distance_mm : {3.0, 10.0, 500.0, 1e6}) {
    CAPTURE(distance_mm);
    const double solid_angle = 2.0 * std::numbers::pi * (1.0 - distance_mm / std::hypot(distance_mm, 3.0));
    const double expected = distance_mm < 1e5 ? distance_mm * distance_mm * solid_angle : std::numbers::pi * 9.0;
    CHECK(meter.direct_flux(LightSource({0, 0, 1}, distance_mm)) == doctest::Approx(expected).epsilon(5e-4));
  }
}

TEST_CASE("the pupil search finds what a dense scan finds, for ghosts of a zoom at a small stop [slow]") {
  const LensState lens = bundled("canon-70-200", {.focal_length_mm = 200.0, .f_number = 32.0});
  const Vec3 d = direction_to_land_at(lens, {5.0, -3.0}, kGreen_nm);
  const EntranceWindow window = entrance_window(lens, d);
  const auto ghosts = enumerate_ghosts(lens, GhostScope::OneSideOfStop);
  const ReflectanceTables tables(lens, kGreen_nm);
  RayGrid scratch;
  constexpr int kScan = 220;
  for (std::size_t g = 0; g < ghosts.size(); g += 13) {
    CAPTURE(ghosts[g].i);
    CAPTURE(ghosts[g].j);
    const OpticalPath path = ghost_path(lens, ghosts[g], kGreen_nm);
    const auto region = find_pupil_region(path, tables, IrisShape(lens.iris), d, window, scratch);
    int outside = 0;
    for (int iy = 0; iy < kScan; ++iy) {
      for (int ix = 0; ix < kScan; ++ix) {
        const Vec2 p{std::lerp(window.min_mm.x, window.max_mm.x, (ix + 0.5) / kScan),
                     std::lerp(window.min_mm.y, window.max_mm.y, (iy + 0.5) / kScan)};
        const TracedRay ray = trace(path, {{p.x, p.y, window.z_mm}, d});
        if (ray.status != RayStatus::Ok || blocked_by(ray, path, lens.iris) > 0.0) continue;
        const bool inside = region && p.x >= region->pupil_mm.low.x && p.x <= region->pupil_mm.high.x &&
                            p.y >= region->pupil_mm.low.y && p.y <= region->pupil_mm.high.y;
        if (!inside) ++outside;
      }
    }
    CHECK(outside == 0);
  }
}

TEST_CASE("a pupil of a ten-thousandth of the window's area is found") {
  LensState lens = test::plate();
  lens.stop_radius_mm = 0.05;
  const GhostMeasure m = GhostMeter(lens, kGreen_nm).measure({2, 3}, Vec3{0, 0, 1});
  const double r = 0.04;
  CHECK(m.flux_mm2 / (std::numbers::pi * 0.0025 * (1 - r) * r * r * (1 - r)) == doctest::Approx(1.0).epsilon(2e-3));
}

// A grid of 577 rays a side for every ghost that lets nothing through had taken up to 50 s where drawing took one.
TEST_CASE("a search looks no finer than twelve times the grid that it is for") {
  CHECK(effort_for_grid(16) == PupilEffort::Once);
  CHECK(effort_for_grid(256) == PupilEffort::Finest);
  for (int side = 16; side <= 512; ++side) {
    const PupilEffort effort = effort_for_grid(side);
    CHECK((effort == PupilEffort::Once || first_grid_side(effort) <= 12 * side));
  }
}

TEST_CASE("an iris polygon cuts the direct flux by its area") {
  LensState lens = test::plate();
  const double open = GhostMeter(lens, kGreen_nm).direct_flux(Vec3{0, 0, 1});
  lens.iris = {6, 0.3};
  CHECK(GhostMeter(lens, kGreen_nm).direct_flux(Vec3{0, 0, 1}) / open ==
        doctest::Approx(iris_area_fraction(lens.iris)).epsilon(1e-3));
  CHECK(iris_area_fraction({6, 0.0}) == doctest::Approx(3.0 * std::sqrt(3.0) / (2.0 * std::numbers::pi)));
}
