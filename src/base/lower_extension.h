// SPDX-License-Identifier: Apache-2.0
// The ending of a file's name by which formats are distinguished: ".exr" for "Plate.EXR".
#pragma once

#include <cctype>
#include <filesystem>
#include <string>

namespace contrejour::inline internal {

// With its dot, ASCII letters in lower case; empty for a name without one.
[[nodiscard]] inline std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

}  // namespace contrejour::inline internal
