// SPDX-License-Identifier: Apache-2.0
// The failures of a driver, as vulkan.hpp and the backend report them.
#include "device.h"
#include "vulkan/device_context.h"
#include "vulkan/raii.h"

namespace contrejour::test {

void lose_device() { throw vk::DeviceLostError("simulated"); }
void exhaust_device() { throw vk::OutOfDeviceMemoryError("simulated"); }
void hang_device() { throw vulkan::Hang("simulated: no answer"); }

}  // namespace contrejour::test
