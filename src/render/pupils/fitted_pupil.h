// SPDX-License-Identifier: Apache-2.0
// The pupil of a fitted ghost, from rays that are evaluated. A fit knows where light enters a wide open lens, so the
// search begins there, and finds what the stop's present opening leaves of it.
#pragma once

#include <span>
#include <vector>

#include "render/pupils/ray_source.h"

namespace contrejour::inline internal::pupils {

// Boxes as those of find_ghost_pupil(), for the outer ones of these wavelengths. lambda_nm: rising, not empty.
[[nodiscard]] std::vector<Rectangle> find_fitted_pupil(const FittedGhost& ghost, std::span<const double> lambda_nm);

}  // namespace contrejour::inline internal::pupils
