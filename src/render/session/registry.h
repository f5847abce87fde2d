// SPDX-License-Identifier: Apache-2.0
// The list of renderers. A new renderer adds its line to registry.cpp.
// Thread-safety: constant.
#pragma once

#include <span>

#include "render/planning/method.h"

namespace contrejour::inline internal {

[[nodiscard]] std::span<const Method> all_methods();  // the default first
[[nodiscard]] const Method* find_method(std::string_view name);  // null: there is none
[[nodiscard]] Result<const Method*> known_method(std::string_view name);  // never null. Errors: none of that name

}  // namespace contrejour::inline internal
