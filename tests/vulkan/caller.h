// SPDX-License-Identifier: Apache-2.0
// A program with a Vulkan device of its own, with the validation layer on: any message is one of messages().
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "base/shared_library.h"
#include "contrejour/expert/vulkan_target.h"
#include "contrejour/image.h"
#include "vulkan/raii.h"

namespace contrejour::test {

struct CallerMemory {
  vk::raii::DeviceMemory memory = nullptr;
  std::byte* mapped = nullptr;
};

struct CallerImage {
  VulkanImage image;
  vk::raii::Image owned = nullptr;
  CallerMemory memory;
};

struct CallerBuffer {
  VulkanBuffer buffer;
  vk::raii::Buffer owned = nullptr;
  CallerMemory memory;  // mapped
};

class Caller {
 public:
  // Null where there is no usable device. has_doubles: whether the device is made with shaderFloat64.
  [[nodiscard]] static std::unique_ptr<Caller> make(bool has_doubles = true);

  [[nodiscard]] VulkanHandles handles() const;
  [[nodiscard]] const vk::raii::Device& device() const { return device_; }

  // In VK_IMAGE_LAYOUT_GENERAL, all of whose numbers are `fill`.
  [[nodiscard]] CallerImage image(std::uint32_t format, int width, int height, float fill);
  [[nodiscard]] CallerBuffer buffer(std::uint32_t format, std::uint64_t bytes, std::uint8_t fill);
  // The bytes of an image in the layout in which it was left, by commands of the caller.
  [[nodiscard]] std::vector<std::byte> bytes_of(const CallerImage& image);
  // Submits commands that wait for a semaphore, and waits for their end.
  void wait_on_queue(vk::Semaphore semaphore);

 private:
  Caller() = default;
  [[nodiscard]] CallerMemory memory_for(const vk::MemoryRequirements& required, bool is_mapped) const;
  template <class Record>
  void run(const Record& record);

  std::unique_ptr<SharedLibrary> library_;
  std::unique_ptr<vk::raii::Context> loader_;
  vk::raii::Instance instance_ = nullptr;
  vk::raii::DebugUtilsMessengerEXT messenger_ = nullptr;
  vk::raii::PhysicalDevice physical_ = nullptr;
  vk::PhysicalDeviceFeatures features_;
  vk::raii::Device device_ = nullptr;
  std::uint32_t family_ = 0;
  vk::raii::Queue queue_ = nullptr;
};

}  // namespace contrejour::test
