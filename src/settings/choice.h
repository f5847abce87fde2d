// SPDX-License-Identifier: Apache-2.0
// Parameters with a choice of words -> enumerators. Thread-safety: a pure function.
#pragma once

#include <algorithm>
#include <string_view>

#include "contrejour/expert/parameter_values.h"

namespace contrejour::params {

// The enumerator at the chosen word's position in the table's list.
template <class Enum>
[[nodiscard]] Enum choice(const Values& values, std::string_view name) {
  const auto& words = parameter(name).choices;
  return static_cast<Enum>(std::find(words.begin(), words.end(), *values.text(name)) - words.begin());
}

}  // namespace contrejour::params
