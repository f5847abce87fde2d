// The irradiance behind a long straight edge, as a table for many look-ups: 0 in the dark, 1 far into the light,
// fringes between, 1.370 at the first (Born & Wolf 8.7.3).
// Places t = d sqrt(2 F), d the distance into the light in stop radii. A band of wavelengths is averaged over: it keeps
// the first fringes and blurs the others away. Accuracy: 1e-4 where one wavelength's fringes are not tapered off, from
// t = 24 on; the light within the table's ends is all there is. Thread-safety: constant after it is made.
#pragma once

#include <vector>

namespace contrejour::screens {

class EdgeProfile {
 public:
  static constexpr double kDarkBelow = -6.0;  // 0.14 per cent at one edge, tapered off
  static constexpr double kLevelAbove = 32.0;

  // spread: of a band's wavelengths, root mean square, over their mean; 0: one wavelength.
  explicit EdgeProfile(double spread);

  // The mean over `width` about t; width may be 0.
  [[nodiscard]] double at(double t, double width) const;

  // From where on it stays within a tolerance of 1.
  [[nodiscard]] double level_above(double tolerance) const;

  // Between dark and level there is all of it but for ripples of less than `ripple`.
  struct Range {
    double dark = kDarkBelow, level = kLevelAbove;
  };
  [[nodiscard]] Range range_above(double ripple) const;
  // What is left out by ending there: squared and summed over t.
  [[nodiscard]] double squared_error(Range range) const;

 private:
  std::vector<double> value_;  // by step from kDarkBelow
  std::vector<double> integral_;  // of it, from kDarkBelow
  std::vector<double> worst_from_;  // how far off 1 it comes from there on
  std::vector<double> brightest_to_;  // the largest before a place and there
  std::vector<double> error_to_, error_from_;  // squares summed of the dark before a place, of what is off 1 from it on
};

}  // namespace contrejour::screens
