// SPDX-License-Identifier: Apache-2.0
// The tables of functions of the test host.
#pragma once

#include "openfx/openfx_abi.h"

namespace contrejour::openfx {

[[nodiscard]] const PropertySuite& property_suite();
[[nodiscard]] const ParameterSuite& parameter_suite();
[[nodiscard]] const ImageEffectSuite& effect_suite();
[[nodiscard]] const MultiThreadSuite& thread_suite();
[[nodiscard]] const MessageSuite& message_suite();
[[nodiscard]] const InteractSuite& interact_suite();
[[nodiscard]] const DrawSuite& draw_suite();

// The suites of a host that acts as MLT does.
[[nodiscard]] const void* mlt_suite(PropertySetHandle host, const char* name, int version);

}  // namespace contrejour::openfx
