// From a photograph's bright areas to lights in front of the lens; apply.h makes the flare of them.
// Pixels are scene-linear RGB with white at 1; pixel coordinates have the origin in the top left corner of the data
// window. Thread-safety: pure functions.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "contrejour/image_io.h"
#include "contrejour/lens.h"
#include "contrejour/light.h"
#include "contrejour/light_detection.h"
#include "contrejour/parameter_values.h"
#include "contrejour/pixel_grid.h"
#include "contrejour/result.h"

namespace contrejour {

struct FlarePlan {
  ColourSpace space = ColourSpace::Rec709;
  double pixel_aspect = 1.0;      // of the picture's pixels as it is shown
  PixelGrid grid;                 // the data window within the display window; its frame is what is rendered
  Detection found;
  std::vector<Light> lights;      // one for each found, in the same order, then those given
  std::size_t given_lights = 0;   // how many these are
  // With --starburst or --glare: the lights whose images are drawn, fewer of them merged. Null: the same as the
  // ghosts'.
  std::shared_ptr<const std::vector<Light>> imaged_lights;
  std::shared_ptr<const Image>
      already_there;  // with --starburst or --glare: the share of each pixel that is a light's own image
  std::vector<std::string> warnings;  // for the user: what was assumed of the picture, or left out
};

// Errors: those of pixel_grid, detect_lights and given_lights; InvalidArgument for a given light without a value, and
// for a picture whose rgb does not fill its data window.
[[nodiscard]] Result<FlarePlan> plan_flare(const Picture& picture, const LensState& lens, const params::Values& values);

}  // namespace contrejour
