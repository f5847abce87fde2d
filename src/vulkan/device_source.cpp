// SPDX-License-Identifier: Apache-2.0
#include "vulkan/device_source.h"

#include <stdexcept>
#include <utility>

namespace contrejour::inline internal::vulkan {

Result<std::unique_ptr<Instance>> open_instance(const DeviceOptions& options) {
  return options.lent ? Instance::borrow(*options.lent) : Instance::open(options.on_message);
}

DeviceSource::DeviceSource(std::unique_ptr<Instance> instance, DeviceInfo info, DeviceOptions options)
    : info_(std::move(info)), options_(std::move(options)), instance_(std::move(instance)) {}

std::shared_ptr<OpenedDevice> DeviceSource::device() {
  const std::scoped_lock lock(mutex_);
  if (device_ && !device_->has_failed()) return device_;
  device_ = nullptr;
  if (!instance_) {
    auto again = open_instance(options_);
    if (!again) throw std::runtime_error(again.error().message);
    instance_ = std::move(*again);
  }
  device_ = std::make_shared<OpenedDevice>(instance_, info_, options_, queue_mutex_);
  return device_;
}

void DeviceSource::abandon(const std::shared_ptr<OpenedDevice>& device) {
  const std::scoped_lock lock(mutex_);
  if (!device->is_abandoned()) OpenedDevice::abandon(device);
  if (device_ != device) return;
  device_ = nullptr;
  instance_ = nullptr;
}

}  // namespace contrejour::inline internal::vulkan
