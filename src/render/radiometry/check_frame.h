// SPDX-License-Identifier: Apache-2.0
// Checks whether pixels can be drawn in a frame.
#pragma once

#include "contrejour/frame.h"
#include "contrejour/result.h"

namespace contrejour::inline internal {

// Errors: InvalidArgument if the frame has no pixels or more than 2^28, if the window or the whole frame is longer or
// farther away than 2^28 pixels, if the pitch is not from 1e-8 to 1e6 mm, or if the shift is not finite.
[[nodiscard]] Result<void> check_frame(const Frame& frame);

}  // namespace contrejour::inline internal
