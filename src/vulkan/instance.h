// SPDX-License-Identifier: Apache-2.0
// The Vulkan loader, opened at run time, and its devices. An absent loader or driver is an error value, no failure.
// Thread-safety: one thread at a time.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <vulkan/vulkan_raii.hpp>

#include "contrejour/expert/devices.h"
#include "contrejour/result.h"

namespace contrejour::inline internal::vulkan {

class Instance {
 public:
  using OnMessage = std::function<void(const std::string&)>;

  // on_message: not empty turns the validation layer on, where it is installed. Errors: Unsupported.
  [[nodiscard]] static Result<std::unique_ptr<Instance>> open(const OnMessage& on_message);

  [[nodiscard]] std::vector<DeviceInfo> devices() const;
  [[nodiscard]] const vk::raii::PhysicalDevice& physical(int index) const {
    return physical_[static_cast<std::size_t>(index)];
  }

 private:
  explicit Instance(OnMessage on_message);
  void listen();

  OnMessage on_message_;
  vk::raii::Context loader_;
  vk::raii::Instance instance_ = nullptr;
  vk::raii::DebugUtilsMessengerEXT messenger_ = nullptr;
  std::vector<vk::raii::PhysicalDevice> physical_;
};

// The first family of queues that computes; -1: there is none.
[[nodiscard]] int compute_family(const vk::raii::PhysicalDevice& device);

}  // namespace contrejour::inline internal::vulkan
