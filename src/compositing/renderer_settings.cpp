// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/renderer_settings.h"

#include "contrejour/expert/settings.h"

namespace contrejour {

Device device_of(const params::Values& values) {
  const std::string name = *values.text("device");
  return name == "vulkan" ? Device::Vulkan : name == "auto" ? Device::Auto : Device::Cpu;
}

Result<void> configure_renderer(Renderer& renderer, const params::Values& values) {
  if (auto set = renderer.set_method(params::method_options(values)); !set) return set;
  return renderer.set_device(device_of(values));
}

}  // namespace contrejour
