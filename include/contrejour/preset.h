// SPDX-License-Identifier: Apache-2.0
// A preset: all settings of a flare except the scene's (lights, size, exposure), under a name, bundled or in a file
// (docs/formats/preset.md).
// Errors: Parse with file, line and remedy; Io; InvalidArgument for a name that is neither bundled nor a file.
// Thread-safety: pure functions.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "contrejour/expert/parameter_values.h"
#include "contrejour/export.h"

namespace contrejour::params {

struct Preset {
  std::string name;         // for display
  std::string description;  // one line
  std::string lens;         // the lens that it was made for, or empty; any may be used
  Values values;
};

[[nodiscard]] CONTREJOUR_API bool belongs_to_preset(const Parameter& parameter);

[[nodiscard]] CONTREJOUR_API Result<Preset> read_preset(std::string_view toml, const std::string& file);
// Writes every parameter of a preset that has a value, given or default, so that later changes of defaults do not
// affect it.
[[nodiscard]] CONTREJOUR_API std::string write_preset(const Preset& preset);

// The bundled presets, by name.
struct BundledPreset {
  std::string_view name;
  std::string_view toml;
};
[[nodiscard]] CONTREJOUR_API std::vector<BundledPreset> bundled_presets();

// Reads a bundled preset, or else a file.
[[nodiscard]] CONTREJOUR_API Result<Preset> find_preset(const std::string& name_or_file);

}  // namespace contrejour::params
