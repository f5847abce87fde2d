// SPDX-License-Identifier: Apache-2.0
// Chooses a few of many wavelengths to trace rays at. The positions where rays meet the sensor, and their
// transmittances, are smooth functions of 1 / lambda^2, in which dispersion is nearly linear (Cauchy), so that
// polynomials through about five samples give the values at the other wavelengths.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace contrejour::inline internal {

// Wavelengths in Leja's order: the two ends first, then each time the one at which the polynomial through those before
// is least determined, so that each can test those before it (Reichel 1990, "Newton interpolation at Leja points", BIT
// 30).
class WavelengthSamples {
 public:
  // Takes the first `max_count` in that order, or fewer if there are not as many different wavelengths.
  WavelengthSamples(std::span<const double> lambda_nm, std::size_t max_count);

  // The index among all wavelengths of the k-th in Leja's order.
  [[nodiscard]] std::size_t operator[](std::size_t k) const { return order_[k]; }
  [[nodiscard]] std::size_t size() const { return order_.size(); }

  // The coordinate of a wavelength in 1 / lambda^2, scaled to [-1, 1]: the two ends are 2 apart.
  [[nodiscard]] double position(std::size_t wavelength) const { return position_[wavelength]; }

  // The weights of the values at the first `count` samples in the interpolation polynomial's value at any wavelength.
  [[nodiscard]] std::vector<double> factors(std::size_t count, std::size_t wavelength) const;
  // Weights for values that coatings make uneven: those of linear interpolation between the two neighbouring samples.
  [[nodiscard]] std::vector<double> linear_weights(std::size_t count, std::size_t wavelength) const;

 private:
  std::vector<double> position_;
  std::vector<std::size_t> order_;
};

}  // namespace contrejour::inline internal
