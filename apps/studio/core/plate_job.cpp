// SPDX-License-Identifier: Apache-2.0
#include "studio/core/plate_job.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "contrejour/expert/flare_plan.h"
#include "studio/core/plate_frames.h"

namespace contrejour::studio {
namespace {

PlateAnswer plate_answer(const PlateOrder& order) {
  PlateAnswer answer{order, nullptr, {}, {}};
  auto frames = frames_of_plate(order.reference);
  if (frames && frames->empty() && is_plate_sequence(order.reference.file))
    frames = failure(ErrorCode::Io, "no frame of the plate exists", {order.reference.file});
  if (frames) {
    answer.frames = std::move(*frames);
    if (!order.frame && !answer.frames.empty()) answer.order.frame = answer.frames.front();
  }
  auto plate = frames ? plate_of(order.reference, answer.order.frame.value_or(0))
                      : Result<std::shared_ptr<const Plate>>(tl::unexpected(frames.error()));
  if (plate)
    answer.plate = std::move(*plate);
  else
    answer.error = plate.error().to_string();
  return answer;
}

}  // namespace

Result<std::shared_ptr<const Plate>> plate_of(const SessionPlate& reference, int frame) {
  const std::string file = plate_at(reference, frame).file;
  std::error_code code;
  if (file != reference.file && !std::filesystem::exists(file, code))
    return failure(ErrorCode::Io, fmt::format("frame {} of the plate is missing", frame), {file});
  ReadOptions options;
  options.layer = reference.layer;
  options.part = reference.part;
  auto plate = read_plate(file, options, {reference.input_space, "", reference.config});
  if (!plate) return tl::unexpected(plate.error());
  return std::make_shared<const Plate>(std::move(*plate));
}

PlateJob::Work plate_work() {
  return [](const PlateOrder& order, PlateJob::Control& control) { control.publish(plate_answer(order)); };
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
