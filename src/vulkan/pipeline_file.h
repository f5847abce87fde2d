// SPDX-License-Identifier: Apache-2.0
// Compiled pipelines as a file of the user's cache folder, one for each device and driver. A file that is absent or
// cannot be written costs the time to compile them, no more.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "vulkan/raii.h"

namespace contrejour::inline internal::vulkan {

[[nodiscard]] std::vector<std::uint8_t> read_pipeline_file(const vk::PhysicalDeviceProperties& device);
void write_pipeline_file(const vk::PhysicalDeviceProperties& device, std::span<const std::uint8_t> data);

}  // namespace contrejour::inline internal::vulkan
