// A picture's samples over the stop, and the distances from the line where they cross a level.
#pragma once

#include <span>
#include <vector>

namespace contrejour {

// On a square of side x side; the outermost ring lies outside the picture.
struct StopSamples {
  int side = 0;
  std::vector<float> value;  // [row from below * side + column]

  [[nodiscard]] std::size_t at(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(side) + static_cast<std::size_t>(i);
  }
};

// level: rows from the top. The longer side spans the square within the ring: large pictures averaged, small ones
// interpolated; 0 beside the picture.
[[nodiscard]] StopSamples samples_over_stop(std::span<const float> level, int width, int height);

// From the line, in samples, negative where the value is at least `level`; the nearest piece of the line is found by
// passing it on between neighbours (Danielsson 1980), which misses it by less than a sample at a few places far away.
[[nodiscard]] StopSamples distances_from_level(const StopSamples& samples, float level);

}  // namespace contrejour
