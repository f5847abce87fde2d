// SPDX-License-Identifier: Apache-2.0
// The rays of a ghost and a light, evaluated from a zone's polynomials in place of being traced.
#pragma once

#include <memory>
#include <vector>

#include "polynomial/field_polynomials.h"
#include "render/pupils/ray_source.h"

namespace contrejour::inline internal::polynomial {

// Over the widest stop: rays beyond it are in a fit (positions up to 1.2), but count less the farther out they are.
inline constexpr double kWidestStop = 1.03;

// From a ghost's zone to its mirror image, and back.
[[nodiscard]] Vec2 mirrored_by(const FoundAsymmetricZone& found, Vec2 v);

struct FieldVector {
  FieldSum along_field, along_pupil;

  FieldVector(const PreparedVector& vector, double field_coordinate)
      : along_field(vector.along_field, field_coordinate), along_pupil(vector.along_pupil, field_coordinate) {}
  // Without axial symmetry: x and y instead.
  FieldVector(const AsymmetricVector& vector, const AsymmetricZone& zone, Vec2 s, const FoundAsymmetricZone& found)
      : along_field(vector.x, parities_of_x(zone), s, {found.mirrored_x, found.mirrored_y, found.mirrored_x}),
        along_pupil(vector.y, parities_of_y(zone), s, {found.mirrored_x, found.mirrored_y, found.mirrored_y}) {}
};

// A zone's polynomials at the field of a light.
struct FieldPolynomials {
  FieldVector sensor_mm;
  std::vector<FieldVector> stop;
  std::vector<FieldSum> rims;
  FieldSum transmittance;
  bool is_symmetric = true;
  double h = 0.0;
  Vec2 centre_mm, radius_mm{1.0, 1.0};  // of pupil points
  double pupil_end = 0.0;  // PolynomialZone's, where symmetric
  double stop_scale = 1.0;  // from the fit's stop radii to the requested ones
  Vec2 shift_mm;  // from the requested entrance plane to the fit's
  Rectangle region;  // that light enters within; its upper half where symmetric

  FieldPolynomials(const PreparedZone& prepared, const PolynomialZone& zone, double field);
  // s: of the light or its mirror image in the zone.
  FieldPolynomials(const FoundAsymmetricZone& found, Vec2 s);
};

// wavelength: its coordinate. field: must outlive the rays.
[[nodiscard]] std::unique_ptr<pupils::RaySource> evaluated_rays(const FieldPolynomials& field, double wavelength);

}  // namespace contrejour::inline internal::polynomial
