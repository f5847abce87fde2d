// SPDX-License-Identifier: Apache-2.0
#include "studio/core/compare.h"

#include <algorithm>
#include <cmath>

namespace contrejour::studio {

Image compared_image(const Image& picture, double pixel_area, const Image& snapshot, const CompareView& view) {
  Image shown = Image::unwritten(picture.width, picture.height);
  const auto mean = static_cast<float>(1 / pixel_area), gain = static_cast<float>(std::exp2(view.gain_stops));
  const int edge = static_cast<int>(std::lround(view.edge * picture.width));
  const bool differs = view.mode == CompareMode::Difference;
  for (int y = 0; y < shown.height; ++y)
    for (int x = 0; x < shown.width; ++x) {
      const int sx = static_cast<int>((x + 0.5) * snapshot.width / shown.width),
                sy = static_cast<int>((y + 0.5) * snapshot.height / shown.height);
      const float* before = &snapshot.pixels[snapshot.index(sx, sy)];
      const float* now = &picture.pixels[picture.index(x, y)];
      float* to = &shown.pixels[shown.index(x, y)];
      for (int c = 0; c < 3; ++c)
        to[c] = differs ? gain * std::fabs(mean * now[c] - before[c]) : x < edge ? before[c] : mean * now[c];
    }
  return shown;
}

CompareJob::Work compare_work() {
  return [](const CompareOrder& order, CompareJob::Control& control) {
    auto figures = compare(*order.snapshot, *order.picture);
    control.publish({figures ? std::optional<Comparison>(*figures) : std::nullopt});
  };
}

}  // namespace contrejour::studio
