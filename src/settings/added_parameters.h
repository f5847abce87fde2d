// SPDX-License-Identifier: Apache-2.0
// Parameters that a program adds to the library's table when it is linked: it defines added_parameters() in an object
// of its own, which takes the place of the library's, whose table is empty. Every front end that is linked so has them.
// Thread-safety: constant data.
#pragma once

#include <span>

#include "contrejour/expert/parameter.h"

namespace contrejour::params {

[[nodiscard]] std::span<const Parameter> added_parameters();

}  // namespace contrejour::params
