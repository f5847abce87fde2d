// SPDX-License-Identifier: Apache-2.0
#include "vulkan/lent_device.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "vulkan/instance.h"

namespace contrejour::inline internal::vulkan {
namespace {

// The handles that are null, by their names.
std::vector<std::string> missing_handles(const VulkanHandles& lent) {
  std::vector<std::string> missing;
  const auto require = [&](bool is_there, const char* name) {
    if (!is_there) missing.push_back(fmt::format("{}: it is null", name));
  };
  require(lent.get_instance_proc_addr != nullptr, "get_instance_proc_addr");
  require(lent.instance != nullptr, "instance");
  require(lent.physical_device != nullptr, "physical_device");
  require(lent.device != nullptr, "device");
  require(lent.queue != nullptr, "queue");
  return missing;
}

// Lists what is wrong with the version and the features that instance and device were made with.
std::vector<std::string> missing_choices(const VulkanHandles& lent) {
  std::vector<std::string> missing;
  if (lent.api_version < VK_API_VERSION_1_3)
    missing.push_back(fmt::format("apiVersion: the instance was made for Vulkan {}.{}, and 1.3 is needed",
                                  VK_API_VERSION_MAJOR(lent.api_version), VK_API_VERSION_MINOR(lent.api_version)));
  if (lent.features == nullptr || lent.features->shaderFloat64 != VK_TRUE)
    missing.emplace_back("shaderFloat64: the device was made without this feature");
  return missing;
}

std::vector<std::string> missing_in_driver(const VulkanHandles& lent) {
  const auto instance = Instance::borrow(lent);
  if (!instance) return {instance.error().message};
  if (!(*instance)->has_physical(lent.physical_device)) return {"physical_device: it is none of the instance's"};
  std::vector<std::string> missing;
  if (const DeviceInfo info = (*instance)->devices().front(); !info.is_usable)
    missing.push_back(fmt::format("physical_device: {}", info.reason));
  const auto families = (*instance)->physical(0).getQueueFamilyProperties();
  if (lent.queue_family >= families.size())
    missing.push_back(
        fmt::format("queue_family: there are {}, and none has the number {}", families.size(), lent.queue_family));
  else if (!(families[lent.queue_family].queueFlags & vk::QueueFlagBits::eCompute))
    missing.push_back(fmt::format("VK_QUEUE_COMPUTE_BIT: the queue family {} does not compute", lent.queue_family));
  return missing;
}

}  // namespace

QueuedDevice::QueuedDevice(const vk::raii::PhysicalDevice& physical, const std::optional<VulkanHandles>& lent) {
  if (lent) {
    family = lent->queue_family;
    device.lend(vk::raii::Device(physical, lent->device));
    queue = vk::raii::Queue(device.object, lent->queue);
    return;
  }
  family = static_cast<std::uint32_t>(compute_family(physical));
  const float priority = 1.0F;
  const vk::DeviceQueueCreateInfo queues({}, family, 1, &priority);
  vk::PhysicalDeviceFeatures features;
  enable_vulkan_features(features);
  device.object = vk::raii::Device(physical, vk::DeviceCreateInfo({}, queues, {}, {}, &features));
  queue = vk::raii::Queue(device.object, family, 0);
}

}  // namespace contrejour::inline internal::vulkan

namespace contrejour {

void enable_vulkan_features(VkPhysicalDeviceFeatures& features) { features.shaderFloat64 = VK_TRUE; }

std::vector<std::string> missing_for_vulkan(const VulkanHandles& handles) {
  std::vector<std::string> missing = vulkan::missing_handles(handles);
  if (!missing.empty()) return missing;
  missing = vulkan::missing_choices(handles);
  try {
    std::ranges::copy(vulkan::missing_in_driver(handles), std::back_inserter(missing));
  } catch (const std::exception& error) {
    missing.push_back(fmt::format("physical_device: its driver fails to describe it ({})", error.what()));
  }
  return missing;
}

}  // namespace contrejour
