// SPDX-License-Identifier: Apache-2.0
// Pictures of the reference that are kept as files, because it takes seconds to minutes for each.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "contrejour/image_io.h"
#include "render/all_methods/methods.h"

namespace contrejour::test {

// What `reference` renders of this scene, read from golden/NAME.exr. To render all of them anew, run this program with
// CONTREJOUR_WRITE_GOLDEN=1, and say why in the commit. Two are rendered in every run ("the reference renders what is
// kept of it"), so that what is kept cannot grow old unseen.
inline Image kept_truth_of(const std::string& name, const LensState& lens, const Light& light,
                           const Settings& settings) {
  const std::filesystem::path file = std::filesystem::path(CONTREJOUR_GOLDEN) / (name + ".exr");
  if (std::getenv("CONTREJOUR_WRITE_GOLDEN") != nullptr) {
    REQUIRE(write_picture(file, picture_of(truth_of(lens, light, settings), SampleType::Float)).has_value());
  }
  const auto kept = read_picture(file);
  REQUIRE(kept.has_value());
  REQUIRE(kept->rgb.width == settings.frame.width);
  REQUIRE(kept->rgb.height == settings.frame.height);
  return kept->rgb;
}

}  // namespace contrejour::test
