// SPDX-License-Identifier: Apache-2.0
// Opens the device that frames in flight share, and opens it anew after a failure, for whoever asks first.
// Failures are exceptions of vulkan.hpp, or std::runtime_error. Thread-safety: several threads at a time.
#pragma once

#include <memory>
#include <mutex>

#include "contrejour/result.h"
#include "render/device/frame_device.h"
#include "vulkan/instance.h"
#include "vulkan/opened_device.h"

namespace contrejour::inline internal::vulkan {

// The instance that the options ask for. Errors: Unsupported.
[[nodiscard]] Result<std::unique_ptr<Instance>> open_instance(const DeviceOptions& options);

class DeviceSource {
 public:
  DeviceSource(std::unique_ptr<Instance> instance, DeviceInfo info, DeviceOptions options);

  // The device, which is opened if it is not, or has failed.
  [[nodiscard]] std::shared_ptr<OpenedDevice> device();
  // A device that gave no answer is abandoned, and so is its instance.
  void abandon(const std::shared_ptr<OpenedDevice>& device);

 private:
  std::mutex mutex_;
  DeviceInfo info_;
  DeviceOptions options_;
  std::shared_ptr<std::mutex> queue_mutex_ = std::make_shared<std::mutex>();
  std::shared_ptr<const Instance> instance_;  // null: it was abandoned
  std::shared_ptr<OpenedDevice> device_;
};

}  // namespace contrejour::inline internal::vulkan
