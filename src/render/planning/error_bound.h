// SPDX-License-Identifier: Apache-2.0
// The RMS error, relative to the frame's peak, that a method may make, or the blurring of extended lights.
#pragma once

#include "contrejour/result.h"

namespace contrejour::inline internal {

// Errors: InvalidArgument unless it is from 1e-4 to 0.1.
[[nodiscard]] Result<void> check_error_bound(double error);

}  // namespace contrejour::inline internal
