// SPDX-License-Identifier: Apache-2.0
// From a photograph's bright areas to lights in front of the lens; apply.h renders their flare.
// Pixels are scene-linear RGB with white at 1; pixel coordinates have the origin in the top left corner of the data
// window. Thread-safety: pure functions.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "contrejour/expert/light_detection.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/expert/pixel_grid.h"
#include "contrejour/export.h"
#include "contrejour/image_io.h"
#include "contrejour/lens.h"
#include "contrejour/light.h"
#include "contrejour/result.h"

namespace contrejour {

struct FlarePlan {
  ColourSpace space = ColourSpace::Rec709;
  double pixel_aspect = 1.0;      // of the picture's pixels as displayed
  PixelGrid grid;                 // the data window within the display window, and the rendered frame
  Detection found;
  std::vector<Light> lights;      // one for each detected light, in the same order, then the given lights
  std::size_t given_light_count = 0;  // the number of lights that the user gave
  // With --starburst or --glare: the lights whose direct images are drawn, with fewer lights merged than in `lights`.
  // Null: `lights`.
  std::shared_ptr<const std::vector<Light>> imaged_lights;
  // With --starburst or --glare: the fraction of each pixel that is a light's own image, which the photograph contains
  // already, as one channel of the frame's size.
  std::shared_ptr<const Image> light_matte;
  std::vector<std::string> warnings;  // for the user: assumptions about the picture, and lights left out
};

// Errors: those of pixel_grid, detect_lights and given_lights; InvalidArgument for a given light without a value, and
// for a picture whose rgb does not fill its data window.
[[nodiscard]] CONTREJOUR_API Result<FlarePlan> plan_flare(const Picture& picture, const LensState& lens,
                                                          const params::Values& values);

}  // namespace contrejour
