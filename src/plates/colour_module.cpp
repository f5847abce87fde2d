// SPDX-License-Identifier: Apache-2.0
#include "plates/colour_module.h"

#include <string_view>

#include <fmt/format.h>

#include "base/module.h"

namespace contrejour::inline internal {

Result<const ColourModule*> colour_module() {
  const auto function = module_function(kColourModuleName, kColourModuleFunction);
  if (!function)
    return failure(ErrorCode::Unsupported,
                   fmt::format("colour spaces need OpenColorIO ({}); convert the picture to a scene-linear OpenEXR "
                               "file, or build with libopencolorio-dev installed",
                               function.error().to_string()));
  const ColourModule* const module = reinterpret_cast<const ColourModule* (*)()>(*function)();
  if (std::string_view(module->version) == kColourModuleVersion) return module;
  return failure(ErrorCode::Unsupported, "the module for OpenColorIO belongs to another version; install both anew");
}

void change_primaries(std::span<float> rgb, ColourSpace from, ColourSpace to) {
  if (from == to) return;
  for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) {
    const Rgb changed = rgb_from_xyz(xyz_from_rgb({rgb[i], rgb[i + 1], rgb[i + 2]}, from), to);
    for (std::size_t c = 0; c < 3; ++c) rgb[i + c] = static_cast<float>(changed[c]);
  }
}

}  // namespace contrejour::inline internal
