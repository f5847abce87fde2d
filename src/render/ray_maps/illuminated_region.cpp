// SPDX-License-Identifier: Apache-2.0
#include "render/ray_maps/illuminated_region.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace contrejour::inline internal::ray_maps {
namespace {

// By how much, in distances between rays, light between four rays may land beyond them. Where one of them fails,
// positions vary as a square root that is steepest there: by two and a half times the last difference, with a margin.
constexpr float kReach = 1.0F, kMarginNextToFailure = 3.0F;

struct PixelBounds {
  float low_x = std::numeric_limits<float>::infinity(), low_y = low_x, high_x = -low_x, high_y = -low_x;
  void add(float x, float y) {
    low_x = std::min(low_x, x), high_x = std::max(high_x, x);
    low_y = std::min(low_y, y), high_y = std::max(high_y, y);
  }
  [[nodiscard]] bool touches(const Frame& frame, float margin) const {
    const float more_x = margin * (high_x - low_x), more_y = margin * (high_y - low_y);
    return high_x + more_x > 0.0F && high_y + more_y > 0.0F && low_x - more_x < static_cast<float>(frame.width) &&
           low_y - more_y < static_cast<float>(frame.height);
  }
};

class IlluminatedCells {
 public:
  IlluminatedCells(const LobattoRays& ray_set, const LightFrame& light, const Frame& frame, bool with_mirror_image)
      : ray_set_(ray_set), frame_(frame), n_(static_cast<std::size_t>(ray_set.nodes)) {
    position(light, 1.0);
    if (with_mirror_image) position(light, -1.0);
  }

  [[nodiscard]] std::optional<Rectangle> part() const {
    return bounds_of_cells(ray_set_, [&](const CellCorners& corners) { return may_be_illuminated(corners); });
  }

 private:
  // Computes the pixels of all nodes, of the box or of its mirror image.
  void position(const LightFrame& light, double side) {
    std::vector<std::array<float, 2>>& pixels = pixels_.emplace_back(ray_set_.count());
    for (std::size_t k = 0; k < ray_set_.count(); ++k) {
      const Vec2 p =
          frame_.pixel_from_sensor(light.to_lens_frame({ray_set_.sensor_x_mm[k], side * ray_set_.sensor_y_mm[k]}));
      pixels[k] = {static_cast<float>(p.x), static_cast<float>(p.y)};
    }
  }

  [[nodiscard]] bool may_be_illuminated(const CellCorners& corners) const {
    if (!may_transmit(ray_set_, corners)) return false;
    const bool all_known = std::ranges::all_of(corners, [&](std::size_t k) { return ray_set_.arrives(k); });
    return std::ranges::any_of(pixels_, [&](const auto& pixels) {
      return all_known ? bounds_of(pixels, corners).touches(frame_, kReach) : lands_near(pixels, corners);
    });
  }

  template <class Nodes>
  [[nodiscard]] PixelBounds bounds_of(const std::vector<std::array<float, 2>>& pixels, const Nodes& nodes) const {
    PixelBounds bounds;
    for (const std::size_t k : nodes)
      if (ray_set_.arrives(k)) bounds.add(pixels[k][0], pixels[k][1]);
    return bounds;
  }

  // Returns whether a cell with a failed corner has another corner about which rays land near the frame.
  [[nodiscard]] bool lands_near(const std::vector<std::array<float, 2>>& pixels, const CellCorners& corners) const {
    return std::ranges::any_of(corners, [&](std::size_t k) {
      return ray_set_.arrives(k) && bounds_of(pixels, around(k)).touches(frame_, kMarginNextToFailure);
    });
  }

  [[nodiscard]] std::vector<std::size_t> around(std::size_t node) const {
    const std::size_t column = node % n_, row = node / n_;
    std::vector<std::size_t> nodes;
    for (std::size_t y = row > 0 ? row - 1 : 0; y <= std::min(row + 1, n_ - 1); ++y)
      for (std::size_t x = column > 0 ? column - 1 : 0; x <= std::min(column + 1, n_ - 1); ++x)
        nodes.push_back(y * n_ + x);
    return nodes;
  }

  const LobattoRays& ray_set_;
  const Frame& frame_;
  std::size_t n_;
  std::vector<std::vector<std::array<float, 2>>> pixels_;
};

}  // namespace

std::optional<Rectangle> illuminated_region(std::span<const LobattoRays> ray_sets, const LightFrame& light,
                                            const Frame& frame, bool with_mirror_image) {
  std::optional<Rectangle> all;
  for (const LobattoRays& ray_set : ray_sets) {
    const auto one = IlluminatedCells(ray_set, light, frame, with_mirror_image).part();
    if (one) all = all ? both(*all, *one) : *one;
  }
  return all;
}

}  // namespace contrejour::inline internal::ray_maps
