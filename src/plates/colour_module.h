// SPDX-License-Identifier: Apache-2.0
// The functions of the module for colour spaces (plate_modules/opencolorio.cpp).
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "contrejour/expert/colour.h"
#include "contrejour/expert/colour_view.h"
#include "contrejour/result.h"

namespace contrejour::inline internal {

struct ColourRequest {
  std::string config;  // a file, or empty: the configuration that this program makes of OpenColorIO's transforms
  std::string space;
  bool to_working = true;  // false: from the working space to this one
};

struct ColourConversion {
  ColourSpace working = ColourSpace::AcesCg;
  std::shared_ptr<const void> transform;
};

struct ColourModule {
  const char* version;  // of this interface; another one is refused
  Result<ColourConversion> (*open)(const ColourRequest& request);
  // From the working space to the codes of a display.
  Result<ColourConversion> (*open_view)(const std::string& config, const ColourViewName& name);
  Result<std::vector<ColourDisplay>> (*displays)(const std::string& config);
  // Converts RGB triples in place. Thread-safe.
  Result<void> (*apply)(const ColourConversion& conversion, float* rgb, std::size_t pixels);
};

inline constexpr const char* kColourModuleVersion = "2";
inline constexpr const char* kColourModuleName = "opencolorio";
inline constexpr const char* kColourModuleFunction = "contrejour_colour_module";

// Errors: Unsupported where the module is not installed, or belongs to another version.
[[nodiscard]] Result<const ColourModule*> colour_module();

// Changes the primaries of linear colours.
void change_primaries(std::span<float> rgb, ColourSpace from, ColourSpace to);

}  // namespace contrejour::inline internal
