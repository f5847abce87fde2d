// Of many wavelengths the few at which rays are traced. Where rays land and what they carry changes so evenly with
// 1 / lambda^2, in which dispersion is nearly linear (Cauchy), that polynomials through some five tell the rest.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace contrejour {

// Wavelengths in Leja's order: first the ends, then each time the one where the polynomial through those before is
// least founded, so that it may serve as their test (Reichel 1990, "Newton interpolation at Leja points", BIT 30).
class WavelengthSamples {
 public:
  // The first `most` in that order, fewer where not so many differ.
  WavelengthSamples(std::span<const double> lambda_nm, std::size_t most);

  // The index among all wavelengths of the k-th in Leja's order.
  [[nodiscard]] std::size_t operator[](std::size_t k) const { return order_[k]; }
  [[nodiscard]] std::size_t size() const { return order_.size(); }

  // Where a wavelength lies in 1 / lambda^2, from -1 to 1: 2 apart are the ends.
  [[nodiscard]] double place(std::size_t wavelength) const { return place_[wavelength]; }

  // What the values at the first `count` in Leja's order are multiplied by to tell the one at any wavelength.
  [[nodiscard]] std::vector<double> factors(std::size_t count, std::size_t wavelength) const;
  // The same for values that films make uneven: those of the straight line between the two neighbours in place.
  [[nodiscard]] std::vector<double> shares(std::size_t count, std::size_t wavelength) const;

 private:
  std::vector<double> place_;
  std::vector<std::size_t> order_;
};

}  // namespace contrejour
