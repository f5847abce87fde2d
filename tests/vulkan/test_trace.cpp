// SPDX-License-Identifier: Apache-2.0
// The formulas of the shaders against those of the CPU, ray by ray: every surface shape, tilted and decentred surfaces,
// rims, absorption, gratings, lights at finite distances, and the reflectances of all coatings of the bundled lenses.
#include <algorithm>
#include <cmath>

#include "base/split_mix.h"
#include "contrejour/expert/ghost.h"
#include "contrejour/lens.h"
#include "contrejour/light.h"
#include "device.h"
#include "ghosts/ray_grid.h"

using namespace contrejour;

namespace {

// Largest deviations of the rays that arrive on both sides.
struct Deviation {
  double sensor_mm = 0, transmission = 0, height = 0, stop = 0;
  std::size_t rays = 0, disagreeing = 0;  // rays that fail on one side alone

  void add(const RayGrid& exact, const DeviceRays& got) {
    for (std::size_t k = 0; k < exact.transmission.size(); ++k) {
      const bool fails = exact.relative_height[k] == kFailed, fails_too = got.relative_height[k] == kFailed;
      if (fails != fails_too) ++disagreeing;
      if (fails || fails_too || exact.relative_height[k] > 1.0F) continue;
      ++rays;
      const auto apart = [k](const std::vector<float>& a, const std::vector<float>& b) {
        return std::abs(static_cast<double>(a[k]) - b[k]);
      };
      sensor_mm =
          std::max({sensor_mm, apart(exact.sensor_x_mm, got.sensor_x_mm), apart(exact.sensor_y_mm, got.sensor_y_mm)});
      transmission =
          std::max(transmission, apart(exact.transmission, got.transmission) / std::max(exact.transmission[k], 1e-9F));
      height = std::max(height, apart(exact.relative_height, got.relative_height));
      for (std::size_t c = 0; c < static_cast<std::size_t>(exact.stop_crossings()); ++c)
        stop = std::max({stop, apart(exact.stop_x[c], got.stop_x[c]), apart(exact.stop_y[c], got.stop_y[c])});
    }
  }
};

// Traces one ghost over the whole entrance window on both sides.
void trace_both(FrameDevice& device, const LensState& lens, Ghost ghost, const LightSource& light, double lambda_nm,
                PacketPrecision precision, Deviation& deviation) {
  const ReflectanceTables tables(lens, lambda_nm);
  const EntranceWindow window = entrance_window(lens, light);
  const Rectangle box{window.min_mm, window.max_mm};
  constexpr int kSide = 64;
  const OpticalPath path = ghost_path(lens, ghost, lambda_nm);
  RayGrid exact;
  exact.trace(path, tables, IrisShape(lens.iris), light, window.z_mm, box, kSide, precision);
  PacketPath packets(path, tables, {{0.0, 0.0, window.z_mm}, light});
  packets.start_from(box.low);
  const DeviceGrid grid{.path = packets, .step_mm = exact.step_mm(), .side = kSide, .precision = precision};
  const auto got = device.trace(grid);
  REQUIRE(got.has_value());
  deviation.add(exact, *got);
}

}  // namespace

TEST_CASE("rays through the bundled lenses arrive as on the CPU") {
  const auto device = test::open_device();
  if (!device) return;
  Deviation in_float, in_double;
  std::uint64_t drawn = 7;
  const auto uniform = [&](double from, double to) {
    drawn += kSplitMixIncrement;
    return from + (to - from) * unit_interval(split_mix(drawn));
  };
  for (const BundledLens& bundled : bundled_lenses()) {
    const auto prescription = find_lens(std::string(bundled.name));
    REQUIRE(prescription.has_value());
    const auto lens = configure_lens(*prescription, {});
    if (!lens) continue;
    const auto ghosts = enumerate_ghosts(*lens, GhostScope::All);
    for (int k = 0; k < 3 && !ghosts.empty(); ++k) {
      const Ghost ghost = ghosts[static_cast<std::size_t>(uniform(0.0, static_cast<double>(ghosts.size())))];
      LightSource light(direction_from_angles(uniform(-0.2, 0.2), uniform(-0.2, 0.2)));
      if (k == 2) light.distance_mm = uniform(500.0, 3000.0);
      const double lambda_nm = uniform(420.0, 680.0);
      trace_both(*device, *lens, ghost, light, lambda_nm, PacketPrecision::Float, in_float);
      trace_both(*device, *lens, ghost, light, lambda_nm, PacketPrecision::Double, in_double);
    }
  }
  INFO("float: ", in_float.rays, " rays, sensor ", in_float.sensor_mm, " mm, transmission ", in_float.transmission,
       ", height ", in_float.height, ", stop ", in_float.stop, ", ", in_float.disagreeing, " disagree");
  INFO("double: ", in_double.rays, " rays, sensor ", in_double.sensor_mm, " mm, transmission ", in_double.transmission,
       ", height ", in_double.height, ", stop ", in_double.stop, ", ", in_double.disagreeing, " disagree");
  CHECK(in_float.rays > 10000);
  CHECK(in_double.rays > 10000);
  CHECK(in_float.sensor_mm < 1e-3);
  CHECK(in_float.transmission < 1e-4);
  CHECK(in_float.height < 1e-4);
  CHECK(in_float.stop < 1e-4);
  CHECK(in_double.sensor_mm < 1e-4);  // a float's resolution of the farthest points
  CHECK(in_double.transmission < 1e-5);
  CHECK(in_double.height < 1e-5);
  CHECK(in_double.stop < 1e-5);
  CHECK(in_float.disagreeing < in_float.rays / 1000);  // rays that graze a surface
  CHECK(in_double.disagreeing < in_double.rays / 1000);
  test::check_no_messages();
}
