// SPDX-License-Identifier: Apache-2.0
// The chords of a square pixel along a direction: their length as a function of the distance from the pixel's middle is
// a trapezoid, the convolution of two boxes of widths |cos| and |sin| of the direction. A line of light adds its chord
// to each pixel, so that a row or column of pixels gets all of its flux wherever the line lies.
#pragma once

#include <algorithm>
#include <cmath>

namespace contrejour::inline internal {

template <class Real>
class PixelProfile {
 public:
  // a, b: a direction's cosines, in either order; width: the pixels', in the caller's unit of distance.
  PixelProfile(Real a, Real b, Real width) {
    const Real wide = std::max(std::abs(a), std::abs(b)) * width, narrow = std::min(std::abs(a), std::abs(b)) * width;
    level_ = Real(0.5) * (wide - narrow);
    extent_ = Real(0.5) * (wide + narrow);
    per_wide_ = Real(1) / wide;
    per_slope_ = narrow > Real(1e-6) * wide ? Real(0.5) * per_wide_ / narrow : Real(0);
  }

  [[nodiscard]] Real extent() const { return extent_; }  // of the pixel's corners

  // The fraction of the pixel below a line at this signed distance: 0 to 1.
  [[nodiscard]] Real fraction_below(Real distance) const {
    const Real d = std::min(std::abs(distance), extent_);
    const Real beyond = d - level_;
    // Half of the pixel less the remaining corner.
    const Real half = beyond > Real(0) ? Real(0.5) - (extent_ - d) * (extent_ - d) * per_slope_ : d * per_wide_;
    return distance < Real(0) ? Real(0.5) - half : Real(0.5) + half;
  }

 private:
  Real level_, extent_, per_wide_, per_slope_;
};

}  // namespace contrejour::inline internal
