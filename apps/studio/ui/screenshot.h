// SPDX-License-Identifier: Apache-2.0
// A picture of the window, as a PNG. Needs a current OpenGL context, before its buffers are swapped.
#pragma once

#include <string>

#include "contrejour/result.h"

namespace contrejour::studio {

[[nodiscard]] Result<void> write_screenshot(const std::string& file, int width, int height);

}  // namespace contrejour::studio
