// SPDX-License-Identifier: Apache-2.0
#include "settings/added_parameters.h"

namespace contrejour::params {

std::span<const Parameter> added_parameters() { return {}; }

}  // namespace contrejour::params
