// SPDX-License-Identifier: Apache-2.0
// A table of the fringes along an iris's edges, for wavelengths that are drawn together and for all channels:
// `adaptive` looks it up for each pixel. Differs: where two edges meet, the channels' means are multiplied instead of
// each wavelength's values.
#pragma once

#include <cstddef>
#include <vector>

#include "render/stop_patterns/band_stop_pattern.h"
#include "render/stop_patterns/stop_pattern.h"

namespace contrejour::inline internal::adaptive {

class EdgeTable {
 public:
  static constexpr std::size_t kStride = 4;  // floats of an entry: three channels and an unused one

  // band: has edges' fringes, and must outlive the table. width: of a pixel, stop radii.
  EdgeTable(const stop_patterns::BandStopPattern& band, double width);

  [[nodiscard]] const IrisShape& iris() const { return *iris_; }
  [[nodiscard]] double dark_beyond() const { return dark_beyond_; }  // distance outside a bound, stop radii
  [[nodiscard]] double level_within() const { return level_within_; }  // the same inside

  // The factors of one bound at even steps of the distance, from 0 at dark_beyond() outside it to 1 at level_within()
  // inside: as steps() if all channels are the same, else as entries().
  [[nodiscard]] bool is_grey() const { return grey_; }
  [[nodiscard]] const float* entries() const { return entries_.data(); }
  struct Step {
    float factor, rise;  // rise: to the next factor; 0 at the last
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

}  // namespace contrejour::inline internal::adaptive
