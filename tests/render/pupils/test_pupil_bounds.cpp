// SPDX-License-Identifier: Apache-2.0
// Precomputed pupil bounds against a search for each angle: no ray that gets through lies outside.
#include <cmath>
#include <random>
#include <string>

#include <doctest/doctest.h>

#include "ghosts/meridian.h"
#include "ghosts/wavelengths.h"
#include "render/pupils/pupil_bounds.h"
#include "support/approx.h"
#include "support/scenes.h"

using namespace contrejour;
using namespace contrejour::pupils;
using test::bundled;
using test::kGreen_nm;

namespace {

constexpr int kSide = 65;  // rays on a side of the grid

double corner_angle_rad(const LensState& lens) {
  const Frame frame = frame_on_sensor(lens, 480, 270);
  return std::acos(direction_for_image_point(lens, frame.sensor_from_uv({1.0, 1.0}), kGreen_nm).z);
}

struct Seen {
  int open = 0;     // rays that get through
  int outside = 0;  // of them, those outside the bounds
  double area_ratio = 1;
};

bool holds(const Rectangle& r, Vec2 p) {
  constexpr double kRounding_mm = 1e-6;
  return p.x > r.low.x - kRounding_mm && p.x < r.high.x + kRounding_mm && p.y > r.low.y - kRounding_mm &&
         p.y < r.high.y + kRounding_mm;
}

class Searcher {
 public:
  explicit Searcher(const LensState& lens) : lens_(lens), tables_(lens, kGreen_nm) {}

  // The pupil that a search at this angle finds, compared with the bounds.
  Seen compare(Ghost ghost, double angle_rad, const std::optional<PupilRegion>& bounds) {
    const Vec3 direction{std::sin(angle_rad), 0.0, std::cos(angle_rad)};
    const EntranceWindow window = entrance_window(lens_, direction);
    const OpticalPath path = ghost_path(lens_, ghost, kGreen_nm);
    const IrisShape circle{Iris{}};
    Seen seen;
    const Pupil found = find_pupil(PupilRays(path, tables_, direction, circle, window), {});
    if (found.is_empty()) return seen;
    grid_.trace(path, tables_, circle, direction, window.z_mm, found.box(), kSide, PacketPrecision::Double);
    const Vec2 step = grid_.step_mm();
    for (int iy = 0; iy < kSide; ++iy) {
      for (int ix = 0; ix < kSide; ++ix) {
        if (grid_.blocked[grid_.at(ix, iy)] > 0.0F) continue;
        ++seen.open;
        if (!bounds || !holds(bounds->pupil_mm, grid_.box().low + Vec2{ix * step.x, iy * step.y})) ++seen.outside;
      }
    }
    if (bounds) seen.area_ratio = area_of(bounds->pupil_mm) / area_of(found.box());
    return seen;
  }

 private:
  const LensState& lens_;
  ReflectanceTables tables_;
  RayGrid grid_;
};

// A few ghosts of each lens at angles of their own, the same in every run.
void check_bounds(const LensState& lens, std::size_t max_ghosts) {
  const auto all = enumerate_ghosts(lens, GhostScope::OneSideOfStop);
  PupilBoundsRange range;
  range.lambda_nm = {kGreen_nm};
  range.largest_angle_rad = corner_angle_rad(lens);
  for (std::size_t k = 0; k < all.size(); k += 1 + all.size() / max_ghosts) range.ghosts.push_back(all[k]);
  const PupilBounds bounds(lens, range, {});
  Searcher searcher(lens);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> angle(0.0, range.largest_angle_rad);
  double ratio = 0.0;
  int looked = 0;
  for (const Ghost ghost : range.ghosts) {
    for (int k = 0; k < 4; ++k) {
      const double a = angle(random);
      CAPTURE(ghost.i);
      CAPTURE(ghost.j);
      CAPTURE(a);
      const Seen seen = searcher.compare(ghost, a, bounds.find(ghost, a));
      CHECK(seen.outside == 0);
      if (seen.open == 0) continue;
      ratio += seen.area_ratio;
      ++looked;
    }
  }
  CHECK(looked > 0);
  CHECK(ratio / looked < 4.0);  // bounds must not be far too wide: they have 1.5 to 3 times the search's rectangle
}

}  // namespace

TEST_CASE("bounds over angles hold every ray that gets through, for all bundled lenses [slow]") {
  for (const BundledLens& lens : bundled_lenses()) {
    CAPTURE(lens.name);
    const std::string name(lens.name);
    if (!bundled(name.c_str()).has_axial_symmetry()) continue;  // has no such bounds
    check_bounds(bundled(name.c_str()), 12);
    check_bounds(bundled(name.c_str(), {.f_number = 16.0}), 12);
  }
}

TEST_CASE("bounds hold every ray of a long zoom at a very small stop, at both ends of the spectrum") {
  const LensState lens = bundled("canon-70-200", {.focal_length_mm = 200.0, .f_number = 32.0});
  check_bounds(lens, 20);
  const Ghost ghost{2, 23};
  const PupilBounds bounds(lens, {{ghost}, {420.0, 680.0}, 0.2}, {});
  for (const double lambda_nm : {420.0, 500.0, 680.0}) {
    const Vec3 direction{std::sin(0.123), 0.0, std::cos(0.123)};
    const ReflectanceTables tables(lens, lambda_nm);
    const OpticalPath path = ghost_path(lens, ghost, lambda_nm);
    const EntranceWindow window = entrance_window(lens, direction);
    const Pupil found = find_pupil(PupilRays(path, tables, direction, IrisShape(Iris{}), window), {});
    REQUIRE_FALSE(found.is_empty());
    // The search's own rectangle is wider than the rays by up to two of its cells of 1/48.
    const Vec2 cell = (found.box().high - found.box().low) * (2.0 / 48.0);
    const auto held = bounds.find(ghost, 0.123);
    REQUIRE(held.has_value());
    CHECK(holds(held->pupil_mm, found.box().low + cell));
    CHECK(holds(held->pupil_mm, found.box().high - cell));
  }
}

TEST_CASE("bounds over zoom and stop hold every ray of the settings between [slow]") {
  const auto lens = find_lens("nikon-80-200");
  REQUIRE(lens.has_value());
  ZoomPupilBounds::Settings settings;
  settings.focal_length_mm = {85.0, 100.0, 120.0, 140.0, 165.0, 190.0};
  settings.f_number = {4.0, 5.6, 8.0, 11.0};
  PupilBoundsRange range;
  const auto all = enumerate_ghosts(bundled("nikon-80-200"), GhostScope::OneSideOfStop);
  for (std::size_t k = 0; k < all.size(); k += 18) range.ghosts.push_back(all[k]);
  range.lambda_nm = {kGreen_nm};
  range.largest_angle_rad = 0.12;
  const auto table = ZoomPupilBounds::build(*lens, settings, range, {});
  REQUIRE(table.has_value());
  int open = 0;
  for (const auto& [focal_length_mm, f_number] : {std::pair{92.0, 6.3}, {110.0, 4.8}, {151.0, 9.5}, {187.0, 7.1}}) {
    const LensState state = bundled("nikon-80-200", {.focal_length_mm = focal_length_mm, .f_number = f_number});
    Searcher searcher(state);
    for (const Ghost ghost : range.ghosts) {
      for (const double angle : {0.013, 0.071, 0.117}) {
        CAPTURE(ghost.i);
        CAPTURE(ghost.j);
        CAPTURE(angle);
        CAPTURE(focal_length_mm);
        const Seen seen = searcher.compare(ghost, angle, table->find(state, ghost, angle));
        CHECK(seen.outside <= seen.open / 1000);
        open += seen.open;
      }
    }
  }
  CHECK(open > 10000);
}

TEST_CASE("a light's meridian is rotated to the lens's frame") {
  const Vec3 direction = normalized({-0.2, 0.3, 1.0});
  const Meridian meridian = meridian_of(direction);
  CHECK(meridian.light.direction.y == 0.0);
  CHECK(meridian.light.direction.x * std::cos(meridian.rotation_rad) == test::approx(direction.x));
  CHECK(meridian.light.direction.x * std::sin(meridian.rotation_rad) == test::approx(direction.y));
  CHECK(std::cos(meridian.angle_rad()) == test::approx(direction.z));
  CHECK(meridian_of(Vec3{0.0, 0.0, 1.0}).rotation_rad == 0.0);
  CHECK(rotated_back(Iris{5, 0.4}, meridian).rotation_rad == test::approx(0.4 - meridian.rotation_rad));
}
