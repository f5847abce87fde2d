// SPDX-License-Identifier: Apache-2.0
// A logical device, and a queue of it that computes: made here, or lent by a caller.
// Failures are exceptions of vulkan.hpp. Thread-safety: one thread at a time.
#pragma once

#include <cstdint>
#include <optional>

#include "contrejour/expert/vulkan_target.h"
#include "vulkan/lendable.h"
#include "vulkan/raii.h"

namespace contrejour::inline internal::vulkan {

struct QueuedDevice {
  // lent: of this physical device; none: a device is made.
  QueuedDevice(const vk::raii::PhysicalDevice& physical, const std::optional<VulkanHandles>& lent);

  std::uint32_t family = 0;
  Lendable<vk::raii::Device> device;
  vk::raii::Queue queue = nullptr;
};

}  // namespace contrejour::inline internal::vulkan
