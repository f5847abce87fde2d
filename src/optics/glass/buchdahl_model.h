// SPDX-License-Identifier: Apache-2.0
// The index of a glass given by n_d, V_d and P_gF alone.
#pragma once

#include "contrejour/expert/glass.h"

namespace contrejour::inline internal {

// n = n_d + v1 w + v2 w^2 in Buchdahl's chromatic coordinate w, through n_d, n_F - n_C and n_g - n_F.
// v_d = 0 means no dispersion. docs/physics/glass.md.
[[nodiscard]] double model_index(const ModelGlass& glass, double lambda_um);

}  // namespace contrejour::inline internal
