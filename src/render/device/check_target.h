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

// The bytes of a pixel in a format; 0: pictures are not written in it.
[[nodiscard]] std::uint32_t pixel_bytes(std::uint32_t format);

}  // namespace contrejour::inline internal
