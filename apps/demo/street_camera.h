// SPDX-License-Identifier: Apache-2.0
// A pinhole camera in the street. Pixels have their origin in the top left corner of the picture.
#pragma once

#include <optional>

#include "contrejour/expert/vec.h"

namespace contrejour::demo {

struct CameraPose {
  Vec3 position{0.5, 1.7, 0.0};  // m
  double yaw_rad = 0, pitch_rad = 0, roll_rad = 0;  // to the right, up, clockwise
};

class StreetCamera {
 public:
  StreetCamera(const CameraPose& pose, int width, int height, double hfov_rad);

  [[nodiscard]] Vec3 position() const { return position_; }
  [[nodiscard]] Vec3 direction_of(Vec2 pixel) const;                  // a unit vector
  [[nodiscard]] std::optional<Vec2> pixel_of(Vec3 point) const;       // none behind the camera
  [[nodiscard]] double pixels_per_solid_angle(Vec3 direction) const;  // direction: a unit vector

 private:
  Vec3 position_, right_, up_, forward_;
  Vec2 axis_px_;
  double scale_;  // tangent per pixel
};

}  // namespace contrejour::demo
