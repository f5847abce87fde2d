// What a whole frame may get wrong, and which items' finer looks are worth their while under it.
#pragma once

#include <cstddef>
#include <vector>

namespace contrejour::adaptive {

// RMS error over the frame's pixels, as a share of the peak.
struct FrameError {
  double error = 0.003, peak = 1.0, pixels = 1.0;
  [[nodiscard]] double squared() const { return error * peak * error * peak * pixels; }  // summed over the pixels
};

// What counts of a level's error: all of it up to the peak, and far above that only its share of the level.
[[nodiscard]] inline double seen_share(double level, double peak) {
  constexpr double kPeaks = 4.0;  // over the peak, where half counts
  return 1.0 / (1.0 + level / (kPeaks * peak));
}

// Of some items' squared errors, by rising error: those beyond what the smallest may make together.
[[nodiscard]] std::vector<std::size_t> worth_drawing(std::vector<std::size_t> some, const std::vector<double>& error,
                                                     double allowed);

}  // namespace contrejour::adaptive
