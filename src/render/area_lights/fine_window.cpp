// SPDX-License-Identifier: Apache-2.0
#include "render/area_lights/fine_window.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace contrejour::inline internal::area {
namespace {

constexpr double kMargin_px = 32.0;  // for the spot's dim surroundings,
constexpr double kColourFringe = 0.03;  // and for lateral colour, over the frame's diagonal

double to_middle(double px) { return std::floor(px) + 0.5 - px; }

}  // namespace

FineWindow window_around(Vec2 at_px, double radius_px, const Frame& frame, int level) {
  const double reach = 2.0 * radius_px + kMargin_px + kColourFringe * std::hypot(frame.width, frame.height);
  const auto within = [](double px, int length) { return static_cast<int>(std::clamp(px, 0.0, 1.0 * length)); };
  FineWindow window;
  window.level = level;
  window.left = within(std::floor(at_px.x - reach), frame.width);
  window.top = within(std::floor(at_px.y - reach), frame.height);
  window.width = within(std::ceil(at_px.x + reach), frame.width) - window.left;
  window.height = within(std::ceil(at_px.y + reach), frame.height) - window.top;
  const Vec2 fine_px = at_px * std::exp2(-level);
  window.moved = {to_middle(fine_px.x), to_middle(fine_px.y)};
  return window;
}

Frame fine_frame(const FineWindow& window, const Frame& frame) {
  const int times = 1 << -window.level;
  const double pitch_mm = frame.pixel_pitch_mm / times;
  // A frame's columns run against the sensor's x.
  const Vec2 moved_mm{-window.moved.x * pitch_mm, window.moved.y * pitch_mm};
  return {window.width * times,
          window.height * times,
          (frame.origin_x + window.left) * times,
          (frame.origin_y + window.top) * times,
          frame.full_width * times,
          frame.full_height * times,
          pitch_mm,
          frame.shift_mm + moved_mm};
}

Image gathered(const FineWindow& window, const Image& fine) {
  const int times = 1 << -window.level;
  Image image(window.width, window.height);
  for (int y = 0; y < fine.height; ++y) {
    const auto from = fine.row(y);
    const auto to = image.row(y / times);
    for (std::size_t k = 0; k < from.size(); ++k) to[k / 3 / static_cast<std::size_t>(times) * 3 + k % 3] += from[k];
  }
  return image;
}

}  // namespace contrejour::inline internal::area
