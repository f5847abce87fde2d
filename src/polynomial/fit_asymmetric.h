// SPDX-License-Identifier: Apache-2.0
// Divides the directions of light of a ghost without axial symmetry into zones, and fits each.
#pragma once

#include "polynomial/fit_asymmetric_zone.h"

namespace contrejour::inline internal::polynomial {

// largest: the tangents up to which directions are fitted, on both sides in x and in y.
[[nodiscard]] GhostPolynomials fit_asymmetric_ghost(const AsymmetricProblem& problem, const LensState& lens,
                                                    const Ghost& ghost, Vec2 largest);

// The tangents of the frame's corners, and a tenth more, or those of options.half_field_rad.
[[nodiscard]] Vec2 largest_tangents(const LensState& lens, const PolynomialOptions& options);

// The planes x = 0 and y = 0 about which all surfaces of the ghost's path are symmetric.
struct MirrorPlanes {
  bool x = false, y = false;
};
[[nodiscard]] MirrorPlanes mirror_planes(const LensState& lens, const Ghost& ghost);

}  // namespace contrejour::inline internal::polynomial
