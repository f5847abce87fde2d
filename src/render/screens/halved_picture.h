// A square picture for look-ups of the mean over a square about any place: samples halved again and again.
// Units: the caller's, of places; 0 outside. Thread-safety: constant after it is made.
#pragma once

#include <span>
#include <vector>

#include "contrejour/vec.h"

namespace contrejour::screens {

class HalvedPicture {
 public:
  // samples: side x side over the square from -extent to extent, rows from the top. side: a multiple of 16 or so, for
  // as many halvings.
  HalvedPicture(int side, double extent, std::vector<float> samples);

  [[nodiscard]] double extent() const { return extent_; }
  [[nodiscard]] int side() const { return levels_.front().side; }
  [[nodiscard]] std::span<const float> samples() const { return levels_.front().samples; }
  // How often samples are halved for a bilinear look-up among them to stand for the mean over a width; 0 and more.
  [[nodiscard]] static double level_for(double width, int side, double extent);
  [[nodiscard]] double at(Vec2 p, double width) const;

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
