// SPDX-License-Identifier: Apache-2.0
// Sample data next to the repository; tests that need them say so and pass where they are absent.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include <doctest/doctest.h>

namespace contrejour::test {

inline std::optional<std::filesystem::path> shared_data(const std::string& file) {
  const char* root = std::getenv("CONTREJOUR_SHARED_DATA");
  if (root != nullptr) {
    const std::filesystem::path path = std::filesystem::path(root) / file;
    if (std::filesystem::exists(path)) return path;
  }
  MESSAGE("SKIPPED: needs ", file, " from the shared data, which is not here");
  return std::nullopt;
}

}  // namespace contrejour::test
