// SPDX-License-Identifier: Apache-2.0
// Definitions that the reader and the writer of lens files share.
#pragma once

#include <string_view>

#include "base/toml_fields.h"
#include "contrejour/expert/coating.h"

namespace contrejour::inline internal {

inline constexpr double kHuge = 1e9;
inline constexpr NumberRange kFinite{-kHuge, kHuge};

// The names of media and coatings that are defined without a table.
[[nodiscard]] inline bool is_reserved_name(std::string_view name) {
  return name == "air" || name == "none" || name == "quarter-wave" || find_coating_design(name);
}

}  // namespace contrejour::inline internal
