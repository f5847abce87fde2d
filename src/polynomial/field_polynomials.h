// SPDX-License-Identifier: Apache-2.0
// A zone's polynomials prepared for evaluation in packets: as powers instead of Chebyshev polynomials, then for the
// field of one light, then for one wavelength. Each step sums over a variable that is known.
#pragma once

#include <vector>

#include "polynomial/asymmetric_basis.h"
#include "polynomial/point_kernels.h"

namespace contrejour::inline internal::polynomial {

// A ChebyshevSum in powers of v and w: coefficients by degree in the wavelength's coordinate, then in u, then by
// power_index() up to the degree that is left.
struct PreparedSum {
  PreparedSum() = default;
  explicit PreparedSum(const ChebyshevSum& sum);

  int degree = 0, wavelength_terms = 0;
  std::vector<float> coefficients;
};

struct PreparedVector {
  PreparedSum along_field, along_pupil;
};

struct PreparedZone {
  PreparedZone() = default;
  // A zone that is Fitted.
  explicit PreparedZone(const PolynomialZone& zone);

  PreparedVector sensor_mm;
  std::vector<PreparedVector> stop;
  std::vector<PreparedSum> rims;
  PreparedSum transmittance;
};

struct Mirroring {
  bool x = false, y = false;  // the pupil point's coordinates
  bool value = false;
};

// A PreparedSum at a field: its powers by wavelength term.
struct FieldSum {
  FieldSum(const PreparedSum& sum, double field_coordinate);
  // A sum of a zone without axial symmetry becomes, at a direction's coordinates, powers of the pupil point's x and y.
  // mirrored: the sum is that of the mirror image, times -1 where the mirror changes the sign of its values.
  FieldSum(const ChebyshevSum& sum, const Parities& parities, Vec2 s, const Mirroring& mirrored);

  [[nodiscard]] PowerSum at(double wavelength_coordinate) const;

  int degree = 0, wavelength_terms = 0;
  std::vector<float> coefficients;
};

}  // namespace contrejour::inline internal::polynomial
