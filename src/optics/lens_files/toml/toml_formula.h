// SPDX-License-Identifier: Apache-2.0
// A catalogue's formula as keys of the lens format (docs/formats/lens-toml.md).
#pragma once

#include <string>

#include "base/toml_fields.h"
#include "contrejour/expert/glass.h"

namespace contrejour::inline internal {

Glass read_formula_keys(const toml::table& table, std::string name, const std::string& what, TomlErrors& errors);
[[nodiscard]] std::string formula_text(const GlassData& data);  // the keys, without braces

}  // namespace contrejour::inline internal
