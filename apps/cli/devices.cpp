// SPDX-License-Identifier: Apache-2.0
// contrejour devices: the devices that can render, their limits, and why one cannot.
#include <memory>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "contrejour/expert/devices.h"

namespace contrejour::cli {
namespace {

constexpr double kMiB = 1024.0 * 1024.0;

Json device_json(const DeviceInfo& device) {
  return {{"index", device.index},
          {"name", device.name},
          {"kind", device.kind},
          {"driver", device.driver},
          {"usable", device.is_usable},
          {"reason", device.is_usable ? Json() : Json(device.reason)},
          {"memory_bytes", device.memory_bytes},
          {"storage_range_bytes", device.storage_range_bytes},
          {"shared_memory_bytes", device.shared_memory_bytes},
          {"groups_an_axis", device.groups_an_axis},
          {"group_size", device.group_size},
          {"subgroup_size", device.subgroup_size},
          {"doubles", device.has_doubles}};
}

std::string device_text(const DeviceInfo& device) {
  return fmt::format(
      "{}  {}\n   {}, {}\n   memory {:.0f} MiB, buffers to {:.0f} MiB, shared {} KiB, {} groups an axis, "
      "{} invocations a group, {} a subgroup\n   {}\n",
      device.index, device.name, device.kind, device.driver, static_cast<double>(device.memory_bytes) / kMiB,
      static_cast<double>(device.storage_range_bytes) / kMiB, device.shared_memory_bytes / 1024, device.groups_an_axis,
      device.group_size, device.subgroup_size,
      device.is_usable ? "usable: --device vulkan" : "unusable: " + device.reason);
}

int print_devices(bool as_json) {
  const auto devices = list_devices();
  if (as_json) {
    Json all = Json::array();
    for (const DeviceInfo& device : devices) all.push_back(device_json(device));
    print_json(all);
    return kDone;
  }
  if (devices.empty()) print_summary("no device with Vulkan was found: frames are rendered by the CPU (docs/gpu.md)\n");
  for (const DeviceInfo& device : devices) print_summary(device_text(device));
  return kDone;
}

}  // namespace

void add_devices(CLI::App& app, Action& action) {
  const auto json = std::make_shared<bool>(false);
  CLI::App* command = app.add_subcommand("devices", "list the GPUs that can render, and why one cannot");
  command->add_flag("--json", *json, "print JSON");
  command->footer("CONTREJOUR_DEVICE, an index or a part of a name, chooses one for --device vulkan.");
  command->callback([json, &action] { action = [json]() -> Result<int> { return print_devices(*json); }; });
}

}  // namespace contrejour::cli
