// SPDX-License-Identifier: Apache-2.0
// The devices on which frames can be rendered besides the CPU: GPUs with Vulkan 1.3 (docs/gpu.md).
// Thread-safety: a pure function; a driver that is absent or broken gives an empty list, or devices that say why they
// are unusable.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "contrejour/export.h"

namespace contrejour {

struct DeviceInfo {
  int index = 0;
  std::string name;    // as the driver names it
  std::string kind;    // "discrete GPU", "integrated GPU", "virtual GPU", "processor" or "other"
  std::string driver;  // name and version
  bool is_usable = false;
  std::string reason;  // why not
  // Limits that the frames depend on.
  std::uint64_t memory_bytes = 0;         // of the largest heap that is local to the device
  std::uint64_t storage_range_bytes = 0;  // of one buffer
  std::uint32_t shared_memory_bytes = 0, groups_an_axis = 0, group_size = 0, subgroup_size = 0;
  bool has_doubles = false;
};

// In the driver's order. Without Vulkan, or built without it: empty.
[[nodiscard]] CONTREJOUR_API std::vector<DeviceInfo> list_devices();

}  // namespace contrejour
