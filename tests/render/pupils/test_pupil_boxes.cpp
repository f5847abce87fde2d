// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include <doctest/doctest.h>

#include "render/pupils/pupil_search.h"
#include "render/ray_maps/ghost_scene.h"

using namespace contrejour;
using namespace contrejour::pupils;

namespace {

// Half the field across the sensor's diagonal.
double half_field_rad(const LensState& lens) {
  const Vec2 corner{0.5 * lens.sensor_width_mm, 0.5 * lens.sensor_height_mm};
  return std::acos(direction_for_image_point(lens, corner, lens.design_wavelength_nm).z);
}

struct Tally {
  std::uint64_t searches = 0, rays = 0, passing = 0, missed = 0, lost = 0, dark = 0, dark_with_boxes = 0;
};

bool in_any(const std::vector<Rectangle>& boxes, Vec2 p) {
  constexpr double kRounding_mm = 1e-5;
  return std::any_of(boxes.begin(), boxes.end(), [&](const Rectangle& b) {
    return p.x >= b.low.x - kRounding_mm && p.x <= b.high.x + kRounding_mm && p.y >= b.low.y - kRounding_mm &&
           p.y <= b.high.y + kRounding_mm;
  });
}

Pupil boxes_of(const OpticalPath& path, const ReflectanceTables& tables, const LightFrame& light,
               const EntranceWindow& window) {
  const PacketPath packets(path, tables, {{0.0, 0.0, window.z_mm}, light.source});
  return find_pupil(PupilRays(packets, window), {.along_meridian = true});
}

// Compares the boxes of one ghost with a grid of 65 x 65 rays over the rectangle that another search finds.
void add(const LensState& lens, Ghost ghost, const ReflectanceTables& tables, const LightFrame& light, Tally& tally) {
  const OpticalPath path = ghost_path(lens, ghost, tables.lambda_nm());
  const EntranceWindow window = entrance_window(lens, light.source);
  const Pupil found = boxes_of(path, tables, light, window);
  ++tally.searches;
  tally.rays += found.rays;
  const IrisShape circle(Iris{});
  RayGrid grid;
  const Pupil other = find_pupil(PupilRays(path, tables, light.source, circle, window), {.effort = PupilEffort::Finer});
  if (other.is_empty()) {
    ++tally.dark;
    tally.dark_with_boxes += found.boxes.empty() ? 0U : 1U;
    return;
  }
  constexpr int kSideOfGrid = 65;
  grid.trace(path, tables, circle, light.source, window.z_mm, other.box(), kSideOfGrid, PacketPrecision::Double);
  const Vec2 step = grid.step_mm();
  std::uint64_t passing = 0;
  std::uint64_t missed = 0;
  for (int iy = 0; iy < kSideOfGrid; ++iy) {
    for (int ix = 0; ix < kSideOfGrid; ++ix) {
      if (!(grid.blocked[grid.at(ix, iy)] <= 0.0F)) continue;
      ++passing;
      if (!in_any(found.boxes, grid.box().low + Vec2{ix * step.x, iy * step.y})) ++missed;
    }
  }
  tally.passing += passing;
  tally.missed += missed;
  if (passing > 0 && missed == passing) ++tally.lost;
}

}  // namespace

TEST_CASE("rays that get through lie in a box, for all lenses [slow]") {
  Tally tally, of_aspheres;
  for (const BundledLens& bundled : bundled_lenses()) {
    const std::string name(bundled.name);
    const LensState wide_open = test::bundled(name.c_str());
    if (!wide_open.has_axial_symmetry()) continue;  // these have another search
    const bool spheres = std::all_of(wide_open.surfaces.begin(), wide_open.surfaces.end(),
                                     [](const SurfaceState& s) { return s.shape.is_sphere(); });
    for (const double f_number : {wide_open.f_number, std::max(11.0, 2.0 * wide_open.f_number)}) {
      const LensState lens = test::bundled(name.c_str(), {.f_number = f_number});
      const ReflectanceTables tables(lens, 550.0);
      const auto ghosts = enumerate_ghosts(lens, GhostScope::OneSideOfStop);
      // About twenty ghosts of each lens, different ones at each angle.
      const std::size_t stride = std::max<std::size_t>(1, ghosts.size() / 20);
      std::size_t first = 0;
      for (const double field : {0.0, 0.37, 0.9}) {
        const double angle_rad = field * half_field_rad(lens);
        const LightFrame light(Vec3{std::sin(angle_rad), 0.0, std::cos(angle_rad)});
        for (std::size_t k = first++ % stride; k < ghosts.size(); k += stride)
          add(lens, ghosts[k], tables, light, spheres ? tally : of_aspheres);
      }
    }
  }
  CHECK(tally.passing > 1'000'000);
  // Should be none. Of these 1572 searches twelve lose rays, nearly all of them where rims leave slivers of a pupil:
  // 0.011 per cent of the rays. No ghost is lost entirely.
  CHECK(tally.missed < tally.passing / 5000);
  CHECK(tally.lost == 0);
  CHECK(tally.rays < 320 * tally.searches);
  CHECK(tally.dark_with_boxes <= tally.dark / 20);
  // The Canon RF 50 mm alone: its ghosts 15-21 and 18-21 at f/11 are lost entirely, each at one of the angles. Should
  // be none.
  CHECK(of_aspheres.missed < of_aspheres.passing / 200);
  CHECK(of_aspheres.lost <= 2);
}

TEST_CASE("boxes are mirror images of each other or of themselves, and fit") {
  const LensState lens = test::lens_at_f("heliar", 8.0);
  const ReflectanceTables tables(lens, 550.0);
  const LightFrame light(direction_from_angles(0.2, 0.13));
  CHECK(light.source.direction.y == 0.0);
  const EntranceWindow window = entrance_window(lens, light.source);
  int boxes = 0;
  for (const Ghost ghost : enumerate_ghosts(lens, GhostScope::All)) {
    const auto found = boxes_of(ghost_path(lens, ghost, 550.0), tables, light, window).boxes;
    for (const Rectangle& box : found) {
      ++boxes;
      CHECK(box.low.x < box.high.x);
      CHECK(box.low.y < box.high.y);
      CHECK(std::any_of(found.begin(), found.end(), [&](const Rectangle& b) {
        return b.low.x == box.low.x && b.high.x == box.high.x && b.low.y == -box.high.y && b.high.y == -box.low.y;
      }));
    }
  }
  CHECK(boxes > 10);
}

TEST_CASE("where no light gets through there are no boxes") {
  const LensState lens = test::lens_at_f("canon-70-200", 8.0, 200.0);
  const ReflectanceTables tables(lens, 550.0);
  const LightFrame light(direction_from_angles(75.0 * std::numbers::pi / 180.0, 0.0));
  const EntranceWindow window = entrance_window(lens, light.source);
  const auto ghosts = enumerate_ghosts(lens, GhostScope::OneSideOfStop);
  for (std::size_t k = 0; k < ghosts.size(); k += 7) {
    CHECK(boxes_of(ghost_path(lens, ghosts[k], 550.0), tables, light, window).is_empty());
  }
}
