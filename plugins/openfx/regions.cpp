// SPDX-License-Identifier: Apache-2.0
#include "openfx/regions.h"

#include <algorithm>
#include <cmath>

#include "openfx/read_parameters.h"

namespace contrejour::openfx {
namespace {

constexpr double kInfinite = 2147483647.0;  // hosts mark a side without an end by the largest integer
constexpr RectD kWithoutProject{0.0, 0.0, 1920.0, 1080.0};

bool is_usable(const RectD& r) {
  for (const double side : {r.x1, r.y1, r.x2, r.y2})
    if (!std::isfinite(side) || std::abs(side) >= kInfinite) return false;
  return r.x2 > r.x1 && r.y2 > r.y1;
}

std::optional<RectD> project_frame(const Instance& instance) {
  const Properties effect = instance.properties();
  const double x = effect.real(name::kProjectOffset, 0).value_or(0.0);
  const double y = effect.real(name::kProjectOffset, 1).value_or(0.0);
  for (const char* size : {name::kProjectSize, name::kProjectExtent}) {
    const RectD frame{x, y, x + effect.real(size, 0).value_or(0.0), y + effect.real(size, 1).value_or(0.0)};
    if (is_usable(frame)) return frame;
  }
  return std::nullopt;
}

// Sides a millionth of a pixel off a whole number are rounding.
int low(double side) { return static_cast<int>(std::floor(std::clamp(side, -1e9, 1e9) + 1e-6)); }
int high(double side) { return static_cast<int>(std::ceil(std::clamp(side, -1e9, 1e9) - 1e-6)); }

}  // namespace

std::optional<RectD> source_region(const Instance& instance, Time time) {
  const ClipHandle source = instance.clip(clip::kSource);
  RectD region{};
  if (!instance.is_connected(source) ||
      instance.host().effects->clip_get_region_of_definition(source, time, &region) != status::kOk ||
      !is_usable(region))
    return std::nullopt;
  return region;
}

SensorFrame sensor_frame_choice(const Instance& instance, Time time) {
  return read_numbers(instance, own::kFrame, time)[0] == 1.0 ? SensorFrame::Source : SensorFrame::Project;
}

RectD sensor_frame(const Instance& instance, Time time, SensorFrame choice) {
  const auto source = source_region(instance, time);
  if (choice == SensorFrame::Source && source) return *source;
  if (const auto project = project_frame(instance)) return *project;
  return source.value_or(kWithoutProject);
}

RectD output_region(const Instance& instance, Time time, SensorFrame choice) {
  RectD region = sensor_frame(instance, time, choice);
  if (const auto source = source_region(instance, time))
    region = {std::min(region.x1, source->x1), std::min(region.y1, source->y1), std::max(region.x2, source->x2),
              std::max(region.y2, source->y2)};
  return region;
}

RectD canonical(const Instance& instance, const RectD& r, const PixelScale& scale) {
  return instance.host().is_mlt() ? RectD{r.x1 / scale.x, r.y1 / scale.y, r.x2 / scale.x, r.y2 / scale.y} : r;
}

PixelWindow pixels_of(const RectD& r, const PixelScale& scale) {
  const double across = scale.x / scale.pixel_aspect;
  const int x1 = low(r.x1 * across), x2 = std::max(high(r.x2 * across), x1 + 1);
  const int y1 = low(r.y1 * scale.y), y2 = std::max(high(r.y2 * scale.y), y1 + 1);
  return {x1, -y2, x2 - x1, y2 - y1};
}

}  // namespace contrejour::openfx
