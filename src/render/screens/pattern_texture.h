// A pattern over the stop plane for look-ups: the mean over a square about any place, from samples halved again and
// again. Units: stop radii. Thread-safety: constant after it is made.
#pragma once

#include <vector>

#include "contrejour/vec.h"

namespace contrejour::screens {

class PatternTexture {
 public:
  // samples: side x side over the square from -extent to extent, rows from the top as in FresnelPattern. side: a
  // multiple of 16 or so, for as many halvings. Outside the square there is nothing.
  PatternTexture(int side, double extent, std::vector<float> samples);

  [[nodiscard]] double extent() const { return extent_; }
  [[nodiscard]] double at(Vec2 p, double width) const;
  [[nodiscard]] double flux() const;  // integral over the plane

 private:
  struct Level {
    int side = 0;
    std::vector<float> samples;
  };
  [[nodiscard]] double bilinear(const Level& level, Vec2 p) const;

  double extent_;
  std::vector<Level> levels_;
};

}  // namespace contrejour::screens
