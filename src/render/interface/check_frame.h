// Whether a frame is one that pixels can be drawn in.
#pragma once

#include "contrejour/frame.h"
#include "contrejour/result.h"

namespace contrejour {

// Errors: InvalidArgument for no pixels, more than 2^28 of them, a window or whole frame more than 2^28 pixels away or
// long, a pitch that is not from 1e-8 to 1e6 mm, a shift that is not finite.
[[nodiscard]] Result<void> check_frame(const Frame& frame);

}  // namespace contrejour
