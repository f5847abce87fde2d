// SPDX-License-Identifier: Apache-2.0
// The reference's cells against a count of rays: no pupil may be lost, however small it is and wherever it lies.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include <doctest/doctest.h>

#include "contrejour/expert/ghost.h"
#include "ghosts/iris_shape.h"
#include "optics/trace/packet_trace.h"
#include "render/reference/flux_image.h"
#include "render/reference/pupil_cells.h"
#include "support/approx.h"
#include "support/scenes.h"

using namespace contrejour;

namespace {

constexpr double kGreen_nm = 550.0;

struct Rectangle {
  Vec2 low, high;
};

// A ghost's light within the frame, at the density that the tables use.
double flux_in_cells(const OpticalPath& path, const Iris& iris, Vec3 direction, const EntranceWindow& window,
                     const Frame& frame) {
  reference::FluxImage image(frame.width, frame.height);
  reference::for_each_lit_polygon(
      path, iris, direction, window, frame, reference::CellLimits::for_density(0.5), [] { return false; },
      [&](std::span<const Vec2> pixels, double flux_mm2) { image.add_polygon(pixels, flux_mm2); });
  std::vector<double> rgb(3 * static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
  image.add_to(rgb, {1.0, 0.0, 0.0});
  return std::accumulate(rgb.begin(), rgb.end(), 0.0);
}

// What a ghost's light is counted from.
struct Scene {
  const OpticalPath& path;
  const ReflectanceTables& tables;
  const Iris& iris;
  Vec3 direction;
  EntranceWindow window;
  Frame frame;
};

// Rays in the middles of side x side cells of a rectangle of the entrance plane.
struct RayCount {
  double flux_mm2 = 0;  // within the frame
  Rectangle open;  // contains the cells of the rays that got through, with a border of two cells
};

RayCount count_rays(const Scene& scene, const Rectangle& where, int side, PacketPrecision precision) {
  const Vec2 step = (where.high - where.low) * (1.0 / side);
  const auto count = static_cast<std::size_t>(side);
  std::array<std::vector<float>, 6 + 2 * kMaxStopCrossings + 1> field;
  for (auto& f : field) f.resize(count);
  auto& [x, y, sensor_x, sensor_y, transmission, relative_height, x0, x1, x2, y0, y1, y2, outside] = field;
  const TracedArrays out{sensor_x.data(),
                         sensor_y.data(),
                         transmission.data(),
                         relative_height.data(),
                         {x0.data(), x1.data(), x2.data()},
                         {y0.data(), y1.data(), y2.data()},
                         nullptr,
                         0};
  const PacketPath packets(scene.path, scene.tables, {{0.0, 0.0, scene.window.z_mm}, scene.direction});
  const IrisShape shape(scene.iris);
  RayCount counted{0.0, {where.high, where.low}};
  for (int row = 0; row < side; ++row) {
    for (std::size_t k = 0; k < count; ++k) {
      x[k] = static_cast<float>(where.low.x + (static_cast<double>(k) + 0.5) * step.x);
      y[k] = static_cast<float>(where.low.y + (row + 0.5) * step.y);
    }
    trace_packets(packets, precision, x.data(), y.data(), count, out);
    for (std::size_t c = 0; c < static_cast<std::size_t>(scene.path.stop_crossings); ++c) {
      shape.distances(out.stop_x[c], out.stop_y[c], count, outside.data());
      for (std::size_t k = 0; k < count; ++k) relative_height[k] = std::max(relative_height[k], outside[k] + 1.0F);
    }
    for (std::size_t k = 0; k < count; ++k) {
      if (!(relative_height[k] <= 1.0F)) continue;
      counted.open.low = {std::min(counted.open.low.x, x[k] - 2.0 * step.x),
                          std::min(counted.open.low.y, y[k] - 2.0 * step.y)};
      counted.open.high = {std::max(counted.open.high.x, x[k] + 2.0 * step.x),
                           std::max(counted.open.high.y, y[k] + 2.0 * step.y)};
      const Vec2 pixel = scene.frame.pixel_from_sensor({sensor_x[k], sensor_y[k]});
      const bool inside =
          pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < scene.frame.width && pixel.y < scene.frame.height;
      if (inside) counted.flux_mm2 += transmission[k] * step.x * step.y * scene.direction.z;
    }
  }
  return counted;
}

// Counts over the whole window, then over the part of it that lets light through.
double counted_flux(const Scene& scene) {
  const RayCount first = count_rays(scene, {scene.window.min_mm, scene.window.max_mm}, 400, PacketPrecision::Float);
  if (first.open.low.x > first.open.high.x) return 0.0;
  return count_rays(scene, first.open, 240, PacketPrecision::Double).flux_mm2;
}

// Checks each `stride`-th ghost. There are few pixels, so that their size does not help the search. Counting may miss
// the ends of a sliver, or all of it; the cells may not.
void check_every_ghost(const LensState& lens, Vec2 light_uv, std::size_t stride, double lambda_nm = kGreen_nm) {
  const Frame frame = frame_on_sensor(lens, 96, 54);
  const Vec3 direction = test::light_at(lens, frame, light_uv).direction;
  const ReflectanceTables tables(lens, lambda_nm);
  const auto ghosts = enumerate_ghosts(lens, GhostScope::OneSideOfStop);
  double all_found = 0.0;
  double all_counted = 0.0;
  for (std::size_t g = 0; g < ghosts.size(); g += stride) {
    CAPTURE(ghosts[g].i);
    CAPTURE(ghosts[g].j);
    const OpticalPath path = ghost_path(lens, ghosts[g], lambda_nm);
    const Scene scene{path, tables, lens.iris, direction, entrance_window(lens, direction), frame};
    const double counted = counted_flux(scene);
    const double found = flux_in_cells(path, lens.iris, direction, scene.window, frame);
    CHECK(found >= 0.98 * counted);
    all_found += found;
    all_counted += counted;
  }
  CHECK(all_found / all_counted == test::approx(1.0).epsilon(5e-3));
}

}  // namespace

TEST_CASE("a pupil far smaller than a root cell is found wherever in it it lies") {
  // A plate 10 mm before a stop of 0.05 mm: its ghost's pupil lies where the light's direction puts it.
  Prescription plate;
  plate.surfaces = {{SurfaceKind::Refracting, 0.0, 2.0, 30.0, {"", ConstantIndex{1.5}}, {}, 0},
                    {SurfaceKind::Refracting, 0.0, 10.0, 30.0, air(), {}, 0},
                    {SurfaceKind::Stop, 0.0, 1.0, 20.0, air(), {}, 0}};
  LensState lens = test::configured(plate, 0.05);
  lens.sensor_z_mm = 20.0;
  const OpticalPath path = ghost_path(lens, {1, 2}, kGreen_nm);
  const double r = 0.04;
  for (const int blades : {0, 6}) {
    lens.iris.blades = blades;
    const double area = std::numbers::pi * 0.05 * 0.05 * iris_area_fraction(lens.iris);
    for (int k = 0; k < 64; ++k) {  // steps of a tenth of a root cell
      CAPTURE(k);
      const Vec3 direction = normalized(Vec3{0.004 * (k % 8), 0.004 * (k / 8), 1.0});
      const EntranceWindow window = entrance_window(lens, direction);
      const double found = flux_in_cells(path, lens.iris, direction, window, {4, 4, 0, 0, 4, 4, 10.0});
      CHECK(found / (area * (1 - r) * r * r * (1 - r) * direction.z) == test::approx(1.0).epsilon(5e-3));
    }
  }
}

// Ghosts 1-7, 2-8, 3-7 and 3-8, whose pupils are about as wide as a root cell, had been lost entirely.
TEST_CASE("every ghost of a zoom at a small stop carries the flux that counted rays do") {
  check_every_ghost(test::bundled("itoh-zoom", {.focal_length_mm = 123.0, .f_number = 32.0}), {0.70, 0.33}, 1);
}

TEST_CASE(
    "ghosts of a lens that is obscured in front, askew on glass and at the stop carry the flux that counted rays do") {
  LensState lens = test::bundled("heliar", {.f_number = 6.0});
  SurfaceState &front = lens.surfaces.front(), &rear = lens.surfaces.back();
  SurfaceState& stop = lens.surfaces[static_cast<std::size_t>(lens.stop_index)];
  const auto disc = [](double radius_mm) { return Obscuration{{radius_mm, radius_mm}, {}, 0.0}; };
  front.obscuration = disc(0.35 * front.semi_diameter_mm);
  check_every_ghost(lens, {0.62, 0.40}, 1);
  front.obscuration = {};
  stop.obscuration = disc(0.5 * lens.stop_radius_mm);
  check_every_ghost(lens, {0.62, 0.40}, 1);
  front.obscuration = disc(0.05 * front.semi_diameter_mm);  // smaller than a root cell
  rear.obscuration = {{0.4 * rear.semi_diameter_mm, 0.2 * rear.semi_diameter_mm}, {1.0, 0.5}, 0.3};
  check_every_ghost(lens, {0.62, 0.40}, 1);
  // Nothing remains of the direct image, or of most ghosts.
  stop.obscuration = disc(0.97 * lens.stop_radius_mm);
  check_every_ghost(lens, {0.62, 0.40}, 3);
}

// Ghost 1-5 of the fisheye: an island as wide as a root cell within rings of rays that miss or are totally reflected.
TEST_CASE("a pupil is found where all rays about it fail") {
  check_every_ghost(test::bundled("muller-fisheye-10"), {0.06, 0.10}, 1, 470.0);
}

TEST_CASE("ghosts of lenses wide open and stopped down carry the flux that counted rays do [slow]") {
  check_every_ghost(test::bundled("canon-70-200", {.focal_length_mm = 200.0, .f_number = 32.0}), {0.25, 0.75}, 40);
  check_every_ghost(test::bundled("nikon-80-200", {.focal_length_mm = 140.0, .f_number = 16.0}), {0.70, 0.33}, 12);
  check_every_ghost(test::bundled("planar-50"), {0.95, 0.95}, 8);
  check_every_ghost(test::bundled("heliar"), {0.5, 0.5}, 3);
}
