// How a square pixel is cut by parallel lines along a direction: the length of its chord by the line's distance from
// its middle is a trapezoid, two boxes of the widths |cos| and |sin| of the direction, one over the other. A line of
// light gives each pixel its chord, so that a row or column of pixels gets all of it wherever it lies.
#pragma once

#include <algorithm>
#include <cmath>

namespace contrejour {

template <class Real>
class PixelProfile {
 public:
  // a, b: a direction's cosines, in either order; width: the pixels', in the caller's unit of distance.
  PixelProfile(Real a, Real b, Real width) {
    const Real wide = std::max(std::abs(a), std::abs(b)) * width, narrow = std::min(std::abs(a), std::abs(b)) * width;
    level_ = Real(0.5) * (wide - narrow);
    reach_ = Real(0.5) * (wide + narrow);
    per_wide_ = Real(1) / wide;
    per_slope_ = narrow > Real(1e-6) * wide ? Real(0.5) * per_wide_ / narrow : Real(0);
  }

  [[nodiscard]] Real reach() const { return reach_; }  // of the pixel's corners

  // The share of the pixel on the near side of a line at this signed distance: 0 to 1.
  [[nodiscard]] Real share_below(Real distance) const {
    const Real d = std::min(std::abs(distance), reach_);
    const Real beyond = d - level_;
    // Half the pixel less the corner that is left.
    const Real half = beyond > Real(0) ? Real(0.5) - (reach_ - d) * (reach_ - d) * per_slope_ : d * per_wide_;
    return distance < Real(0) ? Real(0.5) - half : Real(0.5) + half;
  }

 private:
  Real level_, reach_, per_wide_, per_slope_;
};

}  // namespace contrejour
