// SPDX-License-Identifier: Apache-2.0
#include "openfx/overlay.h"

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "openfx/instance.h"
#include "openfx/overlay_lines.h"
#include "openfx/read_parameters.h"
#include "openfx/regions.h"

namespace contrejour::openfx {
namespace {

constexpr double kRadius_px = 8.0;  // of a handle, on the screen

// Kept with the interact while a light is dragged.
struct Drag {
  int light = 0;  // 0: none
  PointD offset{};  // from the pen to the light
};

// An interact's effect at the time of an action.
struct Viewer {
  const Instance& instance;
  Time time;
  RectD frame;
  PointD pixel;  // the size of a pixel of the screen

  [[nodiscard]] bool is_on(int light) const { return read_numbers(instance, own::light_on(light), time)[0] != 0.0; }
  [[nodiscard]] PointD light(int light) const {
    const auto at = read_numbers(instance, own::light_position(light), time);
    return {frame.x1 + at[0] * (frame.x2 - frame.x1), frame.y1 + at[1] * (frame.y2 - frame.y1)};
  }
  void move_light(int light, PointD to) const {
    const auto k = instance.find(own::light_position(light));
    if (!k || instance.handle(*k) == nullptr) return;
    instance.host().parameters->set_value(instance.handle(*k), (to.x - frame.x1) / (frame.x2 - frame.x1),
                                          (to.y - frame.y1) / (frame.y2 - frame.y1));
  }
};

double pixel_size(const Properties& in, int axis) {
  const double size = in.real(name::kPixelScale, axis).value_or(1.0);
  return std::isfinite(size) && size > 0.0 ? size : 1.0;
}

std::optional<Viewer> viewer_of(const Host& host, const Properties& interact, const Properties& in) {
  void* effect = interact.pointer(name::kEffectInstance);
  if (effect == nullptr) effect = in.pointer(name::kEffectInstance);
  const Instance* const instance = instance_of(host, static_cast<EffectHandle>(effect));
  if (instance == nullptr) return std::nullopt;
  const Time time = in.real(name::kTime).value_or(0.0);
  return Viewer{*instance,
                time,
                sensor_frame(*instance, time, sensor_frame_choice(*instance, time)),
                {pixel_size(in, 0), pixel_size(in, 1)}};
}

void draw_handle(const OverlayLines& lines, PointD at, PointD radius) {
  constexpr int kSides = 24;
  std::array<PointD, kSides> circle;
  for (int k = 0; k < kSides; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / kSides;
    circle[static_cast<std::size_t>(k)] = {at.x + radius.x * std::cos(angle), at.y + radius.y * std::sin(angle)};
  }
  lines.draw(kDrawLineLoop, circle);
  const std::array<PointD, 4> cross = {PointD{at.x - 2 * radius.x, at.y}, PointD{at.x + 2 * radius.x, at.y},
                                       PointD{at.x, at.y - 2 * radius.y}, PointD{at.x, at.y + 2 * radius.y}};
  lines.draw(kDrawLines, cross);
}

Status draw_handles(const Viewer& viewer, const OverlayLines& lines) {
  const PointD radius{kRadius_px * viewer.pixel.x, kRadius_px * viewer.pixel.y};
  for (int light = 1; light <= own::kLights; ++light) {
    if (!viewer.is_on(light)) continue;
    const PointD at = viewer.light(light);
    // A dark line below and to the right lets the light one be seen on white.
    lines.set_colour({0.0F, 0.0F, 0.0F, 1.0F});
    draw_handle(lines, {at.x + viewer.pixel.x, at.y - viewer.pixel.y}, radius);
    lines.set_colour({1.0F, 0.85F, 0.3F, 1.0F});
    draw_handle(lines, at, radius);
  }
  return status::kOk;
}

std::optional<PointD> pen_of(const Properties& in) {
  const auto x = in.real(name::kPenPosition, 0), y = in.real(name::kPenPosition, 1);
  if (!x || !y) return std::nullopt;
  return PointD{*x, *y};
}

// The reply is the standard's for an event that the interact takes.
Status grab(const Viewer& viewer, PointD pen, Drag& drag) {
  for (int light = 1; light <= own::kLights; ++light) {
    if (!viewer.is_on(light)) continue;
    const PointD at = viewer.light(light);
    const PointD offset{at.x - pen.x, at.y - pen.y};
    if (std::hypot(offset.x / viewer.pixel.x, offset.y / viewer.pixel.y) > kRadius_px) continue;
    drag = {light, offset};
    viewer.instance.host().parameters->edit_begin(viewer.instance.parameter_set(), "Move light");
    return status::kOk;
  }
  return status::kReplyDefault;
}

Status act_with_pen(const Viewer& viewer, std::string_view action, PointD pen, Drag& drag) {
  if (action == action::kPenDown) return grab(viewer, pen, drag);
  if (drag.light == 0) return status::kReplyDefault;
  viewer.move_light(drag.light, {pen.x + drag.offset.x, pen.y + drag.offset.y});
  if (action == action::kPenUp) {
    viewer.instance.host().parameters->edit_end(viewer.instance.parameter_set());
    drag = {};
  }
  return status::kOk;
}

}  // namespace

Status act_on_overlay(const Host& host, std::string_view action, InteractHandle interact, const Properties& in,
                      bool has_draw_suite) {
  PropertySetHandle set = nullptr;
  if (interact != nullptr) host.interacts->get_property_set(interact, &set);
  const Properties properties = host.of(set);
  if (action == action::kCreateInstance) {
    properties.set(name::kInstanceData, static_cast<void*>(new Drag));
    return status::kOk;
  }
  auto* const drag = static_cast<Drag*>(properties.pointer(name::kInstanceData));
  if (action == action::kDestroyInstance) {
    const std::unique_ptr<Drag> last(drag);
    properties.set(name::kInstanceData, static_cast<void*>(nullptr));
    return status::kOk;
  }
  const bool is_pen = action == action::kPenDown || action == action::kPenMotion || action == action::kPenUp;
  if (action != action::kDraw && !is_pen) return status::kReplyDefault;
  const auto viewer = viewer_of(host, properties, in);
  if (!viewer) return status::kReplyDefault;
  if (is_pen) {
    const auto pen = pen_of(in);
    return pen && drag != nullptr ? act_with_pen(*viewer, action, *pen, *drag) : status::kReplyDefault;
  }
  auto* const context = static_cast<DrawContext>(in.pointer(name::kDrawContext));
  if (has_draw_suite && context == nullptr) return status::kReplyDefault;
  return draw_handles(*viewer, OverlayLines(host, has_draw_suite ? context : nullptr));
}

}  // namespace contrejour::openfx
