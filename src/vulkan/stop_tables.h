// SPDX-License-Identifier: Apache-2.0
// The stop patterns and the dirt of frames on a device, which stay there until they change.
// Thread-safety: one thread at a time.
#pragma once

#include <cstdint>
#include <memory>

#include "render/device/frame_device.h"
#include "vulkan/device_context.h"

namespace contrejour::inline internal::vulkan {

class StopTables {
 public:
  // Uploads what is not on the device yet; either may be null. Returns the bytes of it.
  std::uint64_t upload(DeviceContext& device, const DeviceInfo& info,
                       const std::shared_ptr<const DevicePatterns>& patterns,
                       const std::shared_ptr<const DeviceDirt>& dirt);

 private:
  std::shared_ptr<const DevicePatterns> patterns_;  // that are uploaded
  std::shared_ptr<const DeviceDirt> dirt_;
};

// The bits of a dispatch's flags that say where dirt lies; null: there is none.
[[nodiscard]] std::uint32_t dirt_flags(const DeviceDirt* dirt);

// The number of the picture that is the iris, from 1 on; 0: the iris is none.
[[nodiscard]] std::uint32_t picture_number(const DevicePatterns* patterns);

}  // namespace contrejour::inline internal::vulkan
