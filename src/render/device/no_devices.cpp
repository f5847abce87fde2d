// SPDX-License-Identifier: Apache-2.0
// Stands for the backend in a library that was built without one.
#include "render/device/frame_device.h"

namespace contrejour::inline internal {

std::vector<DeviceInfo> frame_devices() { return {}; }

Result<std::unique_ptr<FrameDevice>> open_frame_device(const DeviceOptions& /*options*/) {
  return failure(ErrorCode::Unsupported,
                 "this library was built without Vulkan: install libvulkan-dev and glslang-tools, and build it with "
                 "CONTREJOUR_VULKAN=ON");
}

}  // namespace contrejour::inline internal

namespace contrejour {

void enable_vulkan_features(VkPhysicalDeviceFeatures& /*features*/) {}

std::vector<std::string> missing_for_vulkan(const VulkanHandles& /*handles*/) {
  return {"a library with Vulkan: this one was built without it"};
}

}  // namespace contrejour
