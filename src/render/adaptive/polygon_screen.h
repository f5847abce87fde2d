// What stands in the stop behind a polygon, channel by channel, in place of a sharp iris.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "contrejour/vec.h"
#include "render/screens/iris_screens.h"

namespace contrejour::adaptive {

// The screens of some wavelengths that are drawn together, and each one's part of each channel's light.
struct BandScreen {
  struct Part {
    std::shared_ptr<const StopScreen> screen;
    std::array<float, 3> channel{};
  };
  std::vector<Part> parts;

  [[nodiscard]] std::array<double, 3> share(std::span<const StopPlace> places) const;
  // Dark or level where all parts are.
  [[nodiscard]] ScreenPart over(Vec2 middle, double radius) const;

  double unit = 0.1;  // of stop radii: no ripple is much finer
  // Of edges' fringes: beyond these distances outside and inside a bound there are none worth drawing.
  const screens::EdgeScreen* edges = nullptr;  // the first part, if all are such
  double dark_beyond = 0.0, level_within = 0.0;
};

// How a triangle of pixels sees the stop: linear, the nearest place of the triangle for pixels beside it.
class StopMap {
 public:
  struct Corner {
    Vec2 pixel;
    std::array<Vec2, kMaxStopCrossings> stop;  // stop radii
  };
  StopMap(const std::array<Corner, 3>& corners, int crossings);

  // Large and thick enough for the stop's places to be linear a pixel beyond it; then those are
  [[nodiscard]] bool goes_on() const { return thickness_px_ > 2.0 && crossings_ == 1; }
  [[nodiscard]] Vec2 place(Vec2 pixel) const {
    const Vec2 q = pixel - origin_px_;
    return crossing_[0].origin + crossing_[0].along_u * cross(q, u_) + crossing_[0].along_v * cross(v_, q);
  }
  [[nodiscard]] double width() const { return crossing_[0].width; }  // of a pixel in the stop

  // Of a pixel: its middle, and its width in the stop; for a smaller triangle the triangle's.
  [[nodiscard]] std::span<const StopPlace> places(Vec2 pixel, std::array<StopPlace, kMaxStopCrossings>& room) const;

 private:
  struct Crossing {
    Vec2 origin, along_u, along_v;
    double width = 0.0;
  };
  Vec2 origin_px_, u_, v_;  // the triangle's coordinates: cross products with these
  std::array<Crossing, kMaxStopCrossings> crossing_;
  std::size_t crossings_;
  double thickness_px_ = 0.0;
};

}  // namespace contrejour::adaptive
