// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/devices.h"

#include "render/device/frame_device.h"

namespace contrejour {

std::vector<DeviceInfo> list_devices() { return frame_devices(); }

}  // namespace contrejour
