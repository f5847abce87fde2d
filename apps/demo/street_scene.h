// SPDX-License-Identifier: Apache-2.0
// The objects in the street, and the radiance along a ray. Lengths in metres, y up, z down the street.
#pragma once

#include <cstdint>
#include <vector>

#include "contrejour/expert/colour.h"
#include "contrejour/expert/vec.h"

namespace contrejour::demo {

struct Lamp {  // a glowing sphere
  Vec3 centre;
  double radius = 0.1;
  Rgb radiance{};
};

class StreetScene {
 public:
  StreetScene();

  // The radiance along a ray; direction: a unit vector.
  [[nodiscard]] Rgb radiance(Vec3 origin, Vec3 direction) const { return radiance(origin, direction, true); }

 private:
  [[nodiscard]] Rgb radiance(Vec3 origin, Vec3 direction, bool may_reflect) const;
  [[nodiscard]] Rgb lamp_light(Vec3 point, Vec3 normal) const;  // irradiance / pi
  [[nodiscard]] Rgb wall(Vec3 point, double side) const;
  [[nodiscard]] Rgb road(Vec3 point, Vec3 direction, bool may_reflect) const;
  [[nodiscard]] Rgb sky(Vec3 direction) const;

  std::vector<Lamp> lamps_;
};

// A pseudo-random number in 0..1, a function of the three numbers.
[[nodiscard]] double hash01(std::int64_t a, std::int64_t b, std::int64_t c);

}  // namespace contrejour::demo
