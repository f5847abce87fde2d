// SPDX-License-Identifier: Apache-2.0
// The Vulkan loader, opened at run time, and its devices; or those of a caller. An absent loader or driver is an error
// value, no failure.
// Thread-safety: one thread at a time.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/shared_library.h"
#include "contrejour/expert/devices.h"
#include "contrejour/expert/vulkan_target.h"
#include "contrejour/result.h"
#include "vulkan/lendable.h"
#include "vulkan/raii.h"

namespace contrejour::inline internal::vulkan {

class Instance {
 public:
  using OnMessage = std::function<void(const std::string&)>;

  // on_message: not empty turns the validation layer on, where it is installed. Errors: Unsupported.
  [[nodiscard]] static Result<std::unique_ptr<Instance>> open(const OnMessage& on_message);

  // The instance and the one physical device that a caller lends, which exist. Errors: as open().
  [[nodiscard]] static Result<std::unique_ptr<Instance>> borrow(const VulkanHandles& lent);

  [[nodiscard]] std::vector<DeviceInfo> devices() const;
  [[nodiscard]] const vk::raii::PhysicalDevice& physical(int index) const {
    return physical_[static_cast<std::size_t>(index)];
  }
  // Whether the instance has this physical device; of a lent one, too.
  [[nodiscard]] bool has_physical(VkPhysicalDevice device) const;

 private:
  explicit Instance(OnMessage on_message);
  explicit Instance(const VulkanHandles& lent);
  void listen();

  OnMessage on_message_;
  std::unique_ptr<SharedLibrary> library_;  // null: the loader is the caller's
  vk::raii::Context loader_;
  Lendable<vk::raii::Instance> instance_;
  vk::raii::DebugUtilsMessengerEXT messenger_ = nullptr;
  std::vector<vk::raii::PhysicalDevice> physical_;
};

// The first family of queues that computes; -1: there is none.
[[nodiscard]] int compute_family(const vk::raii::PhysicalDevice& device);

}  // namespace contrejour::inline internal::vulkan
