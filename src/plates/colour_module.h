// SPDX-License-Identifier: Apache-2.0
// The functions of the module for colour spaces (plate_modules/opencolorio.cpp).
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "contrejour/expert/colour.h"
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
  // Converts RGB triples in place. Thread-safe.
  Result<void> (*apply)(const ColourConversion& conversion, float* rgb, std::size_t pixels);
};

inline constexpr const char* kColourModuleVersion = "1";
inline constexpr const char* kColourModuleName = "opencolorio";
inline constexpr const char* kColourModuleFunction = "contrejour_colour_module";

}  // namespace contrejour::inline internal
