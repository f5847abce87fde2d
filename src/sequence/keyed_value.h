// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "contrejour/expert/animation.h"

namespace contrejour::inline internal {

// The numbers of a keyed value, which must have some.
[[nodiscard]] std::vector<double> numbers_at(const KeyedValue& value, double frame);

}  // namespace contrejour::inline internal
