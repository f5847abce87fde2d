// SPDX-License-Identifier: Apache-2.0
// Manufacturing errors of a lens: bodies of glass that are slightly tilted and decentred.
#pragma once

#include <vector>

#include "contrejour/lens.h"

namespace contrejour::inline internal {

// Errors: numbers that are not finite or out of their range (lens.h).
[[nodiscard]] Result<void> check_build_errors(const BuildErrors& errors);

// Poses all surfaces of glass (docs/physics/tracing.md); a body's errors depend on the seed and its index in the lens.
void apply_build_errors(const BuildErrors& errors, std::vector<SurfaceState>& surfaces);

}  // namespace contrejour::inline internal
