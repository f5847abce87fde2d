// SPDX-License-Identifier: Apache-2.0
// Simulated captures to test with: a lens turned through a light as walch2018 3.1 does it, its flare by the exact
// renderer, exposed by a simulated sensor, with what goes wrong in a laboratory. No fit is tested on pictures that its
// own model made.
// Errors: InvalidArgument, Cancelled. Thread-safety: pure functions; the same bits for any number of threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/capture.h"
#include "contrejour/export.h"
#include "contrejour/lens.h"
#include "contrejour/result.h"

namespace contrejour {

struct SweepSettings {
  std::vector<double> angles_deg;  // of the head; 0: the light is on the axis, above 0 it appears on the right
  int width = 0, height = 0;       // raw pixels, even, over the sensor's width
  std::vector<double> times_s{0.25, 1.0, 4.0};
  SensorModel sensor;
  double source_radius_rad = 0.00436;  // 0.5 degrees across
  // Errors of the set-up: the RMS error of the head's angle, its zero, the camera's roll, the optical centre's offset
  // from the picture's middle in raw pixels (y down), the room's own light, light scattered in the lens.
  double jitter_deg = 0.02, zero_deg = 0.0, roll_deg = 0.3;
  Vec2 centre_offset_px{5.0, -3.0};
  double room_rate = 3.0;  // DN per second
  double scattered = 0.01;  // fraction of the light, about its image
  double light_rate = 0.0;  // DN per second of the light's direct image, summed over its pixels; 0: so that the
                            // brightest ghosts reach half of saturation in one second
  std::uint64_t seed = 1;
};

// The largest angle at which the light's image is still in the picture, and angles from -to to +to with equal steps.
[[nodiscard]] CONTREJOUR_API double largest_angle_deg(const LensState& lens);
[[nodiscard]] CONTREJOUR_API std::vector<double> even_angles_deg(double to_deg, int stations);

struct SweepStation {
  double angle_deg = 0;  // as the head reports it
  std::vector<RawFrame> exposures;  // of times_s
  std::vector<RawFrame> background;  // the same with the light blocked
  RawFrame direct;  // an exposure so short that the light's own image is not saturated
};

// The rate that light_rate = 0 stands for.
[[nodiscard]] CONTREJOUR_API Result<double> automatic_light_rate(const LensState& lens, const SweepSettings& settings,
                                                                 const Context& context = {});

// The k-th station. Stations are independent of one another: they can be made in any order, and one at a time.
[[nodiscard]] CONTREJOUR_API Result<SweepStation> simulate_station(const LensState& lens, const SweepSettings& settings,
                                                                   std::size_t k, const Context& context = {});

}  // namespace contrejour
