// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "contrejour/expert/animation.h"

namespace contrejour::inline internal {

// A light's value as the command line writes it, for all frames; none for an empty text. Errors: InvalidArgument.
[[nodiscard]] Result<std::optional<KeyedValue>> value_of_text(const std::string& text);

}  // namespace contrejour::inline internal
