// SPDX-License-Identifier: Apache-2.0
// The failures of a driver, as vulkan.hpp reports them.
#include "device.h"
#include "vulkan/raii.h"

namespace contrejour::test {

void lose_device() { throw vk::DeviceLostError("simulated"); }
void exhaust_device() { throw vk::OutOfDeviceMemoryError("simulated"); }

}  // namespace contrejour::test
