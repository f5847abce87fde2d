// SPDX-License-Identifier: Apache-2.0
#include "render/starburst/light_groups.h"

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal {
namespace {

double brightness(const ImagedLight& light) {
  return std::abs(light.flux[0]) + std::abs(light.flux[1]) + std::abs(light.flux[2]);
}

// A cell of the sensor, counted from the axis: a window of a frame has the same cells as the whole frame.
struct Cell {
  double x = 0, y = 0;
  friend bool operator==(const Cell&, const Cell&) = default;
};

Cell cell_of(const ImagedLight& light, const Frame& frame) {
  const double size_px = static_cast<double>(std::max(frame.full_width, frame.full_height)) / kSharingCells;
  return {std::floor((light.centre_px.x + frame.origin_x) / size_px),
          std::floor((light.centre_px.y + frame.origin_y) / size_px)};
}

}  // namespace

std::vector<LightGroup> group_lights(std::span<const Light> lights, std::span<const ImagedLight> imaged,
                                     const Frame& frame) {
  const bool group_by_cells = imaged.size() > kOwnStarbursts;
  std::vector<LightGroup> groups;
  for (const ImagedLight& light : imaged) {
    const auto joins = [&](const LightGroup& group) {
      const ImagedLight& first = group.front();
      if (lights[first.light].spectrum != lights[light.light].spectrum) return false;
      return group_by_cells ? cell_of(first, frame) == cell_of(light, frame)
                            : lights[first.light].source() == lights[light.light].source();
    };
    const auto found = std::find_if(groups.begin(), groups.end(), joins);
    if (found == groups.end())
      groups.push_back({light});
    else
      found->push_back(light);
  }
  for (LightGroup& group : groups)
    std::stable_sort(group.begin(), group.end(),
                     [](const ImagedLight& a, const ImagedLight& b) { return brightness(a) > brightness(b); });
  return groups;
}

}  // namespace contrejour::inline internal
