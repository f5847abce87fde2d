// SPDX-License-Identifier: Apache-2.0
#include "contrejour/frame.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "render/radiometry/check_frame.h"

namespace contrejour {
namespace {

constexpr double kMaxPixels = 268435456.0;  // 2^28
constexpr int kFarthestPixel = 1 << 28;           // as far as a line of all pixels is long
constexpr double kMinPitch_mm = 1e-8, kMaxPitch_mm = 1e6;

}  // namespace

Frame frame_on_sensor(const LensState& lens, int width, int height) {
  Frame frame;
  frame.width = frame.full_width = width;
  frame.height = frame.full_height = height;
  frame.pixel_pitch_mm = std::min(lens.sensor_width_mm / width, lens.sensor_height_mm / height);
  return frame;
}

}  // namespace contrejour

namespace contrejour::inline internal {

Result<void> check_frame(const Frame& f) {
  const auto invalid = [](std::string what) { return failure(ErrorCode::InvalidArgument, std::move(what)); };
  if (f.width <= 0 || f.height <= 0 || f.full_width <= 0 || f.full_height <= 0)
    return invalid(
        fmt::format("a frame of {} x {} pixels has no pixels; give a size of at least 1x1", f.width, f.height));
  if (static_cast<double>(f.width) * f.height > kMaxPixels)
    return invalid(fmt::format("a frame of {} x {} pixels is too large; 2^28 pixels are the limit", f.width, f.height));
  const auto is_near = [](int pixels) { return pixels >= -kFarthestPixel && pixels <= kFarthestPixel; };
  if (!is_near(f.origin_x) || !is_near(f.origin_y) || !is_near(f.full_width) || !is_near(f.full_height))
    return invalid(
        fmt::format("a frame of {} x {} pixels at {}, {} is too large or too far away; {} pixels are the limit",
                    f.full_width, f.full_height, f.origin_x, f.origin_y, kFarthestPixel));
  if (!(f.pixel_pitch_mm >= kMinPitch_mm && f.pixel_pitch_mm <= kMaxPitch_mm))
    return invalid(fmt::format("a pixel pitch of {} mm is out of range; choose {} to {}", f.pixel_pitch_mm,
                               kMinPitch_mm, kMaxPitch_mm));
  if (!std::isfinite(f.shift_mm.x + f.shift_mm.y)) return invalid("a frame's shift must be finite");
  return {};
}

}  // namespace contrejour::inline internal
