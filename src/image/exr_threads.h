// SPDX-License-Identifier: Apache-2.0
// The threads on which OpenEXR compresses a file, which takes longer than drawing most flares.
#pragma once

#include "contrejour/context.h"

namespace contrejour::inline internal {

// The number of worker threads for a file, 0 if the caller's thread is to do all. OpenEXR has one pool of threads for
// the process: this enlarges it as needed and never makes it smaller.
[[nodiscard]] int exr_threads(const Context& context);

}  // namespace contrejour::inline internal
