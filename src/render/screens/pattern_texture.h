// A pattern over the stop plane for look-ups: the mean over a square about any place, and what lies beyond any radius.
// Units: stop radii. Thread-safety: constant after it is made.
#pragma once

#include <span>
#include <vector>

#include "contrejour/vec.h"
#include "render/screens/halved_picture.h"
#include "render/screens/pattern_hull.h"

namespace contrejour::screens {

class PatternTexture {
 public:
  // samples: side x side over the square from -extent to extent, rows from the top as in FresnelPattern. side: a
  // multiple of 16 or so, for as many halvings. Outside the square there is nothing.
  PatternTexture(int side, double extent, std::vector<float> samples);

  [[nodiscard]] double extent() const { return picture_.extent(); }
  [[nodiscard]] int side() const { return picture_.side(); }
  [[nodiscard]] std::span<const float> samples() const { return picture_.samples(); }
  [[nodiscard]] double at(Vec2 p, double width) const { return picture_.at(p, width); }
  [[nodiscard]] double flux() const;  // integral over the plane

  // Beyond this radius it is nowhere brighter than `level`, and a small part of its flux at the most.
  [[nodiscard]] double reach_above(double level) const;
  // Beyond these lines likewise; less than all of it, where it is not round. flux: the share of it that may be beyond.
  [[nodiscard]] PatternHull hull_above(double level, double flux) const;
  [[nodiscard]] double brightest_beyond(double radius) const;
  // Its square, integrated beyond a radius.
  [[nodiscard]] double squared_beyond(double radius) const;

 private:
  struct Rest {  // beyond a radius
    double brightest = 0.0, squared = 0.0, flux = 0.0;
  };
  [[nodiscard]] const Rest& rest_beyond(double radius) const;

  struct SectorRest {
    float brightest = 0.0F, squared = 0.0F, flux = 0.0F;
  };
  [[nodiscard]] std::vector<SectorRest> sector_rings() const;
  void find_rests();
  [[nodiscard]] std::size_t rings() const { return static_cast<std::size_t>(side() / 2); }  // a sample wide

  HalvedPicture picture_;
  std::vector<Rest> rest_;  // by even steps of the radius to the extent
  std::vector<SectorRest> sector_rest_;  // likewise, sector after sector
};

}  // namespace contrejour::screens
