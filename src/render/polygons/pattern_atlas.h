// SPDX-License-Identifier: Apache-2.0
// Tables of stop patterns that lists of polygons refer to by index. Tables are added and never change, so that a device
// copies each once.
// Units: stop radii. Thread-safety: all members may run at once.
#pragma once

#include <cstdint>
#include <deque>
#include <mutex>
#include <vector>

#include "contrejour/expert/iris.h"
#include "contrejour/expert/vec.h"

namespace contrejour::inline internal::raster {

// A pattern over the stop plane, or the patterns of a few wavelengths on a common grid, interleaved. Each level has
// half of the samples a side of the one before, and means over squares that are twice as wide. Samples are those of the
// square from -extent to extent, rows from the top, with a border of dark samples.
struct TextureTable {
  static constexpr std::uint32_t kWavelengths = 3;  // at most
  static constexpr std::uint32_t kStride = 4;  // floats of a sample: one for each wavelength, the rest unused
  // A packed sample (short_light.h) and the one a row below it: four neighbours lie within eight bytes.
  struct Pair {
    std::uint16_t here = 0, below = 0;
  };
  struct Level {
    std::int32_t side = 0;  // without the border
    std::uint32_t first = 0;  // index of its first sample
    std::int32_t lowest = 0;  // of one wavelength: PackedIrradiance::lowest()
    [[nodiscard]] std::int32_t pitch() const { return side + 2; }
  };

  double extent = 0.0;
  std::vector<Level> levels;
  float largest_of_last = 0.0F;  // sample of the last level
  std::vector<Pair> pairs;  // of one wavelength
  std::vector<float> samples;  // of several, kStride each
  [[nodiscard]] bool of_one() const { return samples.empty(); }  // wavelength
};

// The signed distances from the outline of a picture as the iris, side x side, as IrisField interpolates them.
struct OutlineTable {
  std::int32_t side = 0;  // 0: the iris is none
  double cosine = 1.0, sine = 0.0;  // of the picture's rotation in the stop
  std::vector<float> distances;  // rows from below

  OutlineTable() = default;
  explicit OutlineTable(const Iris& iris);
  [[nodiscard]] double distance(Vec2 stop) const;
};

class PatternAtlas {
 public:
  explicit PatternAtlas(const Iris& iris = {}) : outline_(iris) {}

  // Returns the texture's index. References to it remain valid.
  [[nodiscard]] std::uint32_t add(TextureTable texture);
  [[nodiscard]] const TextureTable& texture(std::uint32_t index) const;
  // All textures up to now, by index.
  [[nodiscard]] std::vector<const TextureTable*> textures() const;
  [[nodiscard]] const OutlineTable& outline() const { return outline_; }
  [[nodiscard]] std::size_t bytes() const;  // of all samples

 private:
  OutlineTable outline_;
  mutable std::mutex mutex_;
  std::deque<TextureTable> textures_;
};

}  // namespace contrejour::inline internal::raster
