// SPDX-License-Identifier: Apache-2.0
// The objects in the street, and the radiance along a ray. Lengths in metres, y up, z down the street.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "contrejour/expert/colour.h"
#include "contrejour/expert/vec.h"

namespace contrejour::demo {

struct Lamp {  // a glowing sphere
  Vec3 centre;
  double radius = 0.1;
  Rgb radiance{};
};

struct Pole {  // a dark vertical cylinder that stands on the road
  double x = 0, z = 0, radius = 0.05;
};

[[nodiscard]] std::vector<Lamp> street_lamps();  // two rows along the kerbs
[[nodiscard]] Lamp moon();                       // as a lamp that is very far away

// The fraction of the light that passes a distance of haze.
[[nodiscard]] double haze_transmittance(double distance);

class StreetScene {
 public:
  explicit StreetScene(std::vector<Lamp> lamps, std::vector<Pole> poles = {})
      : lamps_(std::move(lamps)), poles_(std::move(poles)) {}

  // The radiance along a ray; direction: a unit vector.
  [[nodiscard]] Rgb radiance(Vec3 origin, Vec3 direction) const;

  // The same without the discs of the lamps and the moon, and with soft reflections in the road, which do not glitter
  // from frame to frame.
  [[nodiscard]] Rgb background(Vec3 origin, Vec3 direction) const;

  // False if a pole stands between the two points.
  [[nodiscard]] bool is_visible(Vec3 from, Vec3 point) const;

 private:
  enum class Road { Matt, Wet, Damp };
  struct Surface {
    Rgb colour{};
    double distance = 0;  // infinite for the sky
  };

  [[nodiscard]] Rgb radiance(Vec3 origin, Vec3 direction, Road road) const;
  [[nodiscard]] Surface nearest_surface(Vec3 origin, Vec3 direction, Road road) const;
  [[nodiscard]] Rgb lamp_light(Vec3 point, Vec3 normal) const;  // irradiance / pi
  [[nodiscard]] Rgb wall(Vec3 point, double side) const;
  [[nodiscard]] Rgb road(Vec3 point, Vec3 direction, Road kind) const;
  [[nodiscard]] Rgb mirrored(Vec3 point, Vec3 direction) const;  // in a film of water
  [[nodiscard]] Rgb soft_reflections(Vec3 point, Vec3 direction) const;  // of the lamps, in rough wet asphalt
  [[nodiscard]] static Rgb sky(Vec3 direction, bool with_moon);

  std::vector<Lamp> lamps_;
  std::vector<Pole> poles_;
};

// A pseudo-random number in 0..1, a function of the three numbers.
[[nodiscard]] double hash01(std::int64_t a, std::int64_t b, std::int64_t c);

}  // namespace contrejour::demo
