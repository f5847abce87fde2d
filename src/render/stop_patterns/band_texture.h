// SPDX-License-Identifier: Apache-2.0
// The patterns of a few wavelengths on a common grid, interleaved in memory: one look-up serves all that are drawn
// together.
// Units: stop radii. Thread-safety: constant after construction.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "render/stop_patterns/pattern_texture.h"
#include "render/stop_patterns/short_light.h"

namespace contrejour::inline internal::stop_patterns {

class BandTexture {
 public:
  static constexpr std::size_t kMost = 3;    // wavelengths
  static constexpr std::size_t kStride = 4;  // floats of a sample: one for each wavelength, the rest unused
  [[nodiscard]] bool of_one() const { return stride_ == 1; }  // wavelength

  // parts: 1 to kMost.
  explicit BandTexture(std::span<const PatternTexture* const> parts);

  // Samples of the square from -extent to extent, rows from the top, with a border of dark samples.
  struct Level {
    int side = 0;  // without the border
    std::vector<float> samples;  // of several wavelengths
    struct Pair {
      std::uint16_t here = 0, below = 0;
    };
    std::vector<Pair> coded;  // of one, each with the one a row below: four neighbours lie within eight bytes
    ShortLight coding;        // coding of `coded`
    [[nodiscard]] int pitch() const { return side + 2; }
  };
  [[nodiscard]] double extent() const { return extent_; }
  // The level whose samples, interpolated bilinearly, are means over about that width.
  [[nodiscard]] const Level& level_for(double width) const;
  // The largest sample about `middle`, at the level whose samples are `distance` apart; if there is none, the largest
  // of the last level.
  [[nodiscard]] float brightest(Vec2 middle, double distance) const;

 private:
  double extent_ = 0.0;
  std::size_t stride_;
  std::vector<Level> levels_;
  float brightest_of_last_ = 0.0F;
};

}  // namespace contrejour::inline internal::stop_patterns
