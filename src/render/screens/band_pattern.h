// The patterns of a few wavelengths on one grid, side by side in memory: one look-up for all that are drawn together.
// Units: stop radii. Thread-safety: constant after it is made.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/screens/pattern_texture.h"
#include "render/screens/short_light.h"

namespace contrejour::screens {

class BandPattern {
 public:
  static constexpr std::size_t kMost = 3;    // wavelengths
  static constexpr std::size_t kStride = 4;  // floats of a sample: one a wavelength, and one or more unused
  [[nodiscard]] bool of_one() const { return stride_ == 1; }  // wavelength

  // parts: 1 to kMost.
  explicit BandPattern(std::span<const PatternTexture* const> parts);

  // Samples of the square from -extent to extent, rows from the top, with a border of dark ones about it.
  struct Level {
    int side = 0;  // without the border
    std::vector<float> samples;  // of several wavelengths
    struct Pair {
      std::uint16_t here = 0, below = 0;
    };
    std::vector<Pair> coded;  // of one, each beside the one a row below: four neighbours lie within eight bytes
    ShortLight coding;        // likewise
    [[nodiscard]] int pitch() const { return side + 2; }
  };
  [[nodiscard]] double extent() const { return extent_; }
  // The level whose samples, looked up bilinearly, stand for means over about that width.
  [[nodiscard]] const Level& level_for(double width) const;
  // The largest sample about there at the level whose samples are so far apart; if there is none, of all the last
  // one's.
  [[nodiscard]] float brightest(Vec2 middle, double distance) const;

 private:
  double extent_ = 0.0;
  std::size_t stride_;
  std::vector<Level> levels_;
  float brightest_of_last_ = 0.0F;
};

}  // namespace contrejour::screens
