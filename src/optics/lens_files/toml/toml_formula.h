// A catalogue's formula as keys of the lens format (docs/formats/lens-toml.md).
#pragma once

#include <string>

#include "base/toml_fields.h"
#include "contrejour/glass.h"

namespace contrejour {

Glass read_formula_keys(const toml::table& table, std::string name, const std::string& what, TomlErrors& errors);
[[nodiscard]] std::string formula_text(const GlassData& data);  // the keys, without braces

}  // namespace contrejour
