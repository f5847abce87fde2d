// SPDX-License-Identifier: Apache-2.0
// The wave behind a straight edge, as a table for many look-ups: 0 far outside the opening, 1 far inside.
// Behind a rectangle it is a product of differences of two; an opaque shape's wave is 1 minus that of an opening of its
// form (Babinet's principle).
// Units: lengths over s = sqrt(lambda z), z the distance, or its effective value behind a lens. The wave is the mean
// amplitude over a band of wavelengths, so that its fringes have the band's blur. Fringes farther than kReach from the
// edge are omitted, and tapered from kTaperFrom on. Accuracy: 1e-3 of the incident amplitude within kTaperFrom.
// Thread-safety: constant after it is made. Source: Goodman 2005 eq. 4-17, Born & Wolf 8.7.3.
#pragma once

#include <algorithm>
#include <complex>
#include <vector>

namespace contrejour::inline internal {

class StraightEdge {
 public:
  static constexpr double kReach = 3.0, kTaperFrom = 2.0;

  // spread: of a band's wavelengths over their mean, root mean square; 0: one wavelength.
  explicit StraightEdge(double spread);

  // t: distance inside the opening, negative outside.
  [[nodiscard]] std::complex<float> at(double t) const {
    const double position = std::clamp((t + kReach) * kSteps, 0.0, 2.0 * kReach * kSteps);
    const auto k = static_cast<std::size_t>(position);
    return value_[k] + change_[k] * static_cast<float>(position - static_cast<double>(k));
  }

 private:
  static constexpr double kSteps = 128.0;  // steps a unit: a fringe at kReach has 40 of them
  std::vector<std::complex<float>> value_, change_;  // by step from -kReach, and to the next
};

}  // namespace contrejour::inline internal
