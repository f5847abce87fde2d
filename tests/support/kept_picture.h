// SPDX-License-Identifier: Apache-2.0
// Pictures that are kept as files, because it takes seconds to minutes to render each.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include <doctest/doctest.h>

#include "contrejour/image_io.h"

namespace contrejour::test {

// The picture golden/NAME.exr beside the test's sources, which is what render() returned. To render all of a test
// program's pictures anew, run it with CONTREJOUR_WRITE_GOLDEN=1, and say why in the commit.
template <class Render>
Image kept_picture(const std::string& name, Render render, SampleType type = SampleType::Float) {
  const std::filesystem::path file = std::filesystem::path(CONTREJOUR_GOLDEN) / (name + ".exr");
  if (std::getenv("CONTREJOUR_WRITE_GOLDEN") != nullptr) {
    std::filesystem::create_directories(file.parent_path());
    REQUIRE(write_picture(file, picture_of(render(), type)).has_value());
  }
  const auto kept = read_picture(file);
  REQUIRE_MESSAGE(kept.has_value(), (kept ? "" : kept.error().to_string()));
  return kept->rgb;
}

}  // namespace contrejour::test
