// SPDX-License-Identifier: Apache-2.0
// A renderer that follows a user's settings: the method and its options, and the device.
// Errors: those of Renderer::set_method and set_device. Thread-safety: as of a Renderer.
#pragma once

#include "contrejour/expert/parameter_values.h"
#include "contrejour/export.h"
#include "contrejour/renderer.h"

namespace contrejour {

// Sets method and device to the values'. What has not changed is kept.
[[nodiscard]] CONTREJOUR_API Result<void> configure_renderer(Renderer& renderer, const params::Values& values);

// The device that the values name.
[[nodiscard]] CONTREJOUR_API Device device_of(const params::Values& values);

}  // namespace contrejour
