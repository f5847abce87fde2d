// SPDX-License-Identifier: Apache-2.0
// The polynomials of the direct image at a sensor point and a stop point, with their derivatives.
#pragma once

#include <array>
#include <span>

#include "contrejour/expert/direct_polynomials.h"
#include "polynomial/chebyshev_basis.h"

namespace contrejour::inline internal::polynomial {

// Matrix of derivatives: row the component, column the coordinate by which it is.
struct Derivative2 {
  Vec2 by_x, by_y;
  [[nodiscard]] double determinant() const { return cross(by_x, by_y); }
};

struct VectorAt {
  Vec2 value;
  Derivative2 by_sensor, by_stop;  // by mm, by widest stop radii
};

// A sensor point, a stop point and a wavelength in the basis' variables.
class DirectPoint {
 public:
  DirectPoint(const DirectPolynomials& polynomials, Vec2 sensor_mm, Vec2 stop, double lambda_nm);

  [[nodiscard]] VectorAt at(const ChebyshevVector& vector) const;
  [[nodiscard]] double at(const ChebyshevSum& sum) const { return sum_at(sum)[0]; }

 private:
  using Values = std::array<double, kMaxDegree + 1>;
  struct Variable {
    Values values{}, slopes{};
    explicit Variable(double x);
  };
  // The value, and the derivatives by u, v and w.
  [[nodiscard]] std::array<double, 4> sum_at(const ChebyshevSum& sum) const;

  Vec2 h_, p_;
  double h_per_mm_;
  Variable u_, v_, w_;
  std::array<double, kMaxWavelengthTerms> wavelength_{};
};

// The coordinate of a wavelength between the polynomials' shortest (1) and longest (-1), and its inverse.
[[nodiscard]] double direct_wavelength(const DirectPolynomials& polynomials, double lambda_nm);
[[nodiscard]] double direct_wavelength_nm(const DirectPolynomials& polynomials, double coordinate);

}  // namespace contrejour::inline internal::polynomial
