// SPDX-License-Identifier: Apache-2.0
// A lens's dirt as the shaders read it (shaders/stop/dirt.glsl). Thread-safety: a pure function.
#pragma once

#include <cstdint>
#include <vector>

#include "render/device/device_dirt.h"

namespace contrejour::inline internal::vulkan {

// A DirtHeader, followed by its tables.
[[nodiscard]] std::vector<std::uint32_t> dirt_words(const DeviceDirt& dirt);

}  // namespace contrejour::inline internal::vulkan
