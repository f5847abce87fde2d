// SPDX-License-Identifier: Apache-2.0
#include "optics/lens/sensor_stack.h"

#include <cmath>

#include <fmt/format.h>

#include "optics/lens/validate.h"

namespace contrejour::inline internal {
namespace {

constexpr double kThickest_mm = 100.0, kWidestGap_mm = 1000.0;
constexpr double kFinestPitch_mm = 1e-4, kWidestPitch_mm = 1.0;

Result<void> check_plate(const SensorPlate& plate) {
  if (!(plate.thickness_mm > 0.0 && plate.thickness_mm <= kThickest_mm) ||
      !(plate.gap_mm >= 0.0 && plate.gap_mm <= kWidestGap_mm)) {
    return invalid_argument(
        fmt::format("a plate of {} mm, {} mm before what follows; give a thickness to {} and a gap to {} mm",
                    plate.thickness_mm, plate.gap_mm, kThickest_mm, kWidestGap_mm));
  }
  if (const auto problem = glass_problem(plate.glass))
    return invalid_argument("a plate before the sensor: " + *problem);
  if (const auto problem = coating_problem(plate.coating))
    return invalid_argument("a plate before the sensor: " + *problem);
  return {};
}

// A semi-diameter far beyond the frame, so that plates do not block light next to the sensor.
double wide_mm(const LensState& lens) {
  return 100.0 * (std::hypot(lens.sensor_width_mm, lens.sensor_height_mm) + std::abs(lens.focal_length_mm));
}

Coating reflecting(double reflectance) { return {"sensor", MeasuredCoating{{kLineD_nm}, {0.0}, {reflectance}}}; }

}  // namespace

Result<void> check_sensor_stack(const SensorStack& stack) {
  if (stack.plates.size() > SensorStack::kMaxPlates)
    return invalid_argument(
        fmt::format("{} plates before the sensor; give {} at most", stack.plates.size(), SensorStack::kMaxPlates));
  for (const SensorPlate& plate : stack.plates)
    if (const auto good = check_plate(plate); !good) return good;
  if (!(stack.reflectance >= 0.0 && stack.reflectance <= 1.0))
    return invalid_argument(fmt::format("a sensor that reflects {}; give a fraction from 0 to 1", stack.reflectance));
  const bool fits = stack.orders >= 0 && stack.orders <= SensorStack::kMaxOrders && stack.pitch_mm >= kFinestPitch_mm &&
                    stack.pitch_mm <= kWidestPitch_mm && stack.fill > 0.0 && stack.fill <= 1.0;
  if (fits) return {};
  return invalid_argument(
      fmt::format("pixels of {} um, {} of them filled, {} orders; give a pitch from {} to {} um, a fill to "
                  "1 and {} orders at most",
                  stack.pitch_mm * 1e3, stack.fill, stack.orders, kFinestPitch_mm * 1e3, kWidestPitch_mm * 1e3,
                  SensorStack::kMaxOrders));
}

Result<void> add_sensor_stack(const SensorStack& stack, const SourcePosition& position, LensState& lens) {
  if (stack.plates.empty() && stack.reflectance == 0.0) return {};
  double stack_mm = 0.0;
  for (const SensorPlate& plate : stack.plates) {
    lens.sensor_z_mm += plate.thickness_mm * (1.0 - 1.0 / refractive_index(plate.glass, lens.design_wavelength_nm));
    stack_mm += plate.thickness_mm + plate.gap_mm;
  }
  const double last_z_mm = lens.surfaces.back().z_mm;
  double z_mm = lens.sensor_z_mm - stack_mm;
  if (!(z_mm >= last_z_mm)) {
    return failure(ErrorCode::InvalidArgument,
                   fmt::format("the plates before the sensor need {:.4g} mm; the lens leaves {:.4g} mm", stack_mm,
                               lens.sensor_z_mm - last_z_mm),
                   position);
  }
  const double semi_mm = wide_mm(lens);
  for (const SensorPlate& plate : stack.plates) {
    SurfaceState front{SurfaceKind::Refracting, z_mm, 0.0, semi_mm, air(), plate.glass, {}};
    front.coating = placed_on(plate.coating, front.before, front.after);
    SurfaceState back{SurfaceKind::Refracting, z_mm + plate.thickness_mm, 0.0, semi_mm, plate.glass, air(), {}};
    back.coating = placed_on(plate.coating, back.before, back.after);
    lens.surfaces.push_back(front);
    lens.surfaces.push_back(back);
    z_mm = back.z_mm + plate.gap_mm;
  }
  if (stack.reflectance == 0.0) return {};
  SurfaceState sensor{SurfaceKind::Sensor, lens.sensor_z_mm, 0.0, semi_mm, air(), air(), reflecting(stack.reflectance)};
  sensor.aperture.kind = ApertureKind::Rectangle;
  sensor.aperture.half_mm = {0.5 * lens.sensor_width_mm, 0.5 * lens.sensor_height_mm};
  lens.surfaces.push_back(sensor);
  lens.sensor_grating = {stack.orders, stack.pitch_mm, stack.fill};
  return {};
}

}  // namespace contrejour::inline internal
