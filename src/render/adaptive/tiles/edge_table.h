// The fringes along an iris's edges for the wavelengths that are drawn together, as one table for all channels: what
// adaptive looks up pixel by pixel. Differs: where two edges meet, the channels' means multiply, not each wavelength's.
#pragma once

#include <cstddef>
#include <vector>

#include "render/screens/band_screen.h"
#include "render/screens/iris_screens.h"

namespace contrejour::adaptive {

class EdgeTable {
 public:
  static constexpr std::size_t kStride = 4;  // floats of an entry: three channels and an unused one

  // band: of edges' fringes, which must outlive the table. width: of a pixel, stop radii.
  EdgeTable(const screens::BandScreen& band, double width);

  [[nodiscard]] const IrisShape& iris() const { return *iris_; }
  [[nodiscard]] double dark_beyond() const { return dark_beyond_; }  // distance outside a bound, stop radii
  [[nodiscard]] double level_within() const { return level_within_; }  // and inside

  // The factors that a bound brings, from 0 at dark_beyond() outside it to 1 at level_within() inside, at even steps:
  // steps where all channels are the same, else entries.
  [[nodiscard]] bool is_grey() const { return grey_; }
  [[nodiscard]] const float* entries() const { return entries_.data(); }
  struct Step {
    float factor, rise;  // to the next; none at the last
  };
  [[nodiscard]] const std::vector<Step>& steps() const { return steps_; }
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] double per_step() const { return per_step_; }  // entries a stop radius

 private:
  const IrisShape* iris_;
  bool grey_;
  double dark_beyond_, level_within_, per_step_;
  std::size_t count_;
  std::vector<float> entries_;
  std::vector<Step> steps_;
};

}  // namespace contrejour::adaptive
