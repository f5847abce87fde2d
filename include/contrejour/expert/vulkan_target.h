// SPDX-License-Identifier: Apache-2.0
// A flare drawn on a Vulkan device of the caller, into the caller's image or buffer, without a copy in the host's
// memory: Renderer::set_vulkan_device(), then Renderer::render_to_vulkan() (docs/gpu.md).
// Handles have Vulkan's own types, which are declared here and not included: a VkDevice is assigned without a cast, and
// a program without Vulkan needs none of its headers. Formats and layouts are the numbers of VkFormat, VkImageLayout.
// Ownership: the library destroys what it made, and nothing else. What is lent outlives the renderer, or its next
// set_device(). Thread-safety: pure functions. The queue is used during calls of the renderer only, in which no thread
// of the caller may use it; renderers made by Renderer::another() take turns at it.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "contrejour/export.h"

struct VkInstance_T;
struct VkPhysicalDevice_T;
struct VkDevice_T;
struct VkQueue_T;
struct VkImage_T;
struct VkBuffer_T;
struct VkSemaphore_T;
struct VkPhysicalDeviceFeatures;

namespace contrejour {

using VulkanFunction = void (*)();  // PFN_vkVoidFunction
using VulkanGetInstanceProcAddr = VulkanFunction (*)(VkInstance_T*, const char*);  // PFN_vkGetInstanceProcAddr

// A device that a caller made, for Vulkan 1.3, with the features of enable_vulkan_features(). No extensions or layers
// are needed; those that are on are in use.
struct VulkanHandles {
  VulkanGetInstanceProcAddr get_instance_proc_addr = nullptr;  // of the loader that made the instance
  VkInstance_T* instance = nullptr;
  std::uint32_t api_version = 0;  // VkApplicationInfo::apiVersion of the instance
  VkPhysicalDevice_T* physical_device = nullptr;
  VkDevice_T* device = nullptr;
  // The features that `device` was made with (VkDeviceCreateInfo::pEnabledFeatures, or a VkPhysicalDeviceFeatures2's
  // `features`), since Vulkan cannot be asked for them later. Null: none. It is read before the call returns.
  const VkPhysicalDeviceFeatures* features = nullptr;
  VkQueue_T* queue = nullptr;  // which computes
  std::uint32_t queue_family = 0;
};

// Sets the features that the library needs (shaderFloat64) in those that will be given to vkCreateDevice(), and leaves
// the others as they are.
CONTREJOUR_API void enable_vulkan_features(VkPhysicalDeviceFeatures& features);

// Lists everything that a lent device lacks by its name in Vulkan or in VulkanHandles, with the reason; empty: the
// device is usable.
// Handles that are neither null nor Vulkan's are undefined behaviour.
[[nodiscard]] CONTREJOUR_API std::vector<std::string> missing_for_vulkan(const VulkanHandles& handles);

// The formats of a pixel: red, green, blue, and an alpha of 0, with which the operator "over" adds the premultiplied
// flare to its background. Values are scene-linear, as in other targets. Half floats end at 65504, to which larger
// values are clipped.
inline constexpr std::uint32_t kVulkanRgba32Float = 109;  // VK_FORMAT_R32G32B32A32_SFLOAT
inline constexpr std::uint32_t kVulkanRgba16Float = 97;  // VK_FORMAT_R16G16B16A16_SFLOAT

// A two-dimensional colour image of the device with one sample, of which the frame replaces pixels of mip level 0 and
// layer 0. Its usage includes VK_IMAGE_USAGE_TRANSFER_DST_BIT; the queue's family owns it, or all share it.
struct VulkanImage {
  VkImage_T* image = nullptr;
  std::uint32_t format = kVulkanRgba32Float;
  int width = 0, height = 0;  // of the image, in pixels
  int left = 0, top = 0;  // the frame's upper left pixel
  std::uint32_t layout_before = 0;  // VK_IMAGE_LAYOUT_UNDEFINED: pixels around the frame are lost
  std::uint32_t layout_after = 1;  // VK_IMAGE_LAYOUT_GENERAL, or another that the image's usage allows
};

// A buffer whose usage includes VK_BUFFER_USAGE_TRANSFER_DST_BIT. Pixels lie row by row from the top, without gaps.
struct VulkanBuffer {
  VkBuffer_T* buffer = nullptr;
  std::uint32_t format = kVulkanRgba32Float;  // of a pixel: 16 bytes, or 8
  std::uint64_t size_bytes = 0;  // of the buffer
  std::uint64_t offset_bytes = 0;  // of the frame's upper left pixel
};

struct VulkanSemaphore {
  VkSemaphore_T* semaphore = nullptr;  // null: none
  std::uint64_t value = 0;  // of a timeline semaphore
};

struct VulkanTarget {
  std::variant<VulkanImage, VulkanBuffer> to;
  VulkanSemaphore wait = {};  // before the image or buffer is written; the frame itself is drawn before
  VulkanSemaphore signal = {};  // afterwards
};

}  // namespace contrejour
