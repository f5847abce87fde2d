// SPDX-License-Identifier: Apache-2.0
// Checks a caller's image or buffer against a frame, before anything is drawn. Thread-safety: pure functions.
#pragma once

#include <cstdint>

#include "contrejour/expert/vulkan_target.h"
#include "contrejour/result.h"

namespace contrejour::inline internal {

// Errors: InvalidArgument: null handles, a format that is not written, a frame that does not fit, a layout in which an
// image cannot be left.
[[nodiscard]] Result<void> check_target(const VulkanTarget& target, int width, int height);

// Of a pixel; 0: the format is none that is written.
[[nodiscard]] std::uint32_t pixel_bytes(std::uint32_t format);

}  // namespace contrejour::inline internal
