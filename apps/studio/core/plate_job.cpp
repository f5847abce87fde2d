// SPDX-License-Identifier: Apache-2.0
#include "studio/core/plate_job.h"

#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/flare_plan.h"

namespace contrejour::studio {

Result<std::shared_ptr<const Plate>> plate_of(const SessionPlate& reference) {
  ReadOptions options;
  options.layer = reference.layer;
  options.part = reference.part;
  auto plate = read_plate(reference.file, options, {reference.input_space, "", reference.config});
  if (!plate) return tl::unexpected(plate.error());
  return std::make_shared<const Plate>(std::move(*plate));
}

PlateJob::Work plate_work() {
  return [](const PlateOrder& order, PlateJob::Control& control) {
    auto plate = plate_of(order.reference);
    if (plate)
      control.publish({order, std::move(*plate), {}});
    else
      control.publish({order, nullptr, plate.error().to_string()});
  };
}

Result<std::vector<LightEntry>> lights_in_plate(const Plate& plate, params::Values values, const LensState& lens) {
  if (auto ok = values.set("detect", "on"); !ok) return tl::unexpected(ok.error());
  const auto plan = plan_flare(plate.picture, lens, values);
  if (!plan) return tl::unexpected(plan.error());
  std::vector<LightEntry> lights;
  for (const DetectedLight& found : plan->found.lights) {
    const Vec2 at = plan->grid.frame.uv_from_sensor(plan->grid.sensor_from_pixel(found.centroid_px));
    lights.push_back(
        {at, fmt::format("{:.6g},{:.6g},{:.6g}", found.flux[0], found.flux[1], found.flux[2]), "", "", ""});
  }
  return lights;
}

DetectionJob::Work detection_work() {
  return [](const DetectionOrder& order, DetectionJob::Control& control) {
    auto lights = lights_in_plate(*order.plate, order.values, *order.lens);
    if (lights)
      control.publish({std::move(*lights), {}});
    else
      control.publish({{}, lights.error().to_string()});
  };
}

}  // namespace contrejour::studio
