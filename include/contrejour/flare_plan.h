// From a photograph's bright areas to lights in front of the lens, and from the flare back onto the photograph.
// Pixels are scene-linear RGB with white at 1; pixel coordinates have the origin in the top left corner of the data
// window. Thread-safety: pure functions.
#pragma once

#include <memory>
#include <vector>

#include "contrejour/image_io.h"
#include "contrejour/light.h"
#include "contrejour/light_detection.h"
#include "contrejour/parameter_values.h"
#include "contrejour/pixel_grid.h"

namespace contrejour::params {

struct FlarePlan {
  ColourSpace space = ColourSpace::Rec709;
  bool space_is_guessed = false;  // the file names primaries that are neither Rec.709's nor ACEScg's
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
};

// Errors: those of pixel_grid, detect_lights and given_lights; InvalidArgument for a given light without a value.
[[nodiscard]] Result<FlarePlan> plan_flare(const Picture& picture, const LensState& lens, const Values& values);

// Adds the flare, and takes nothing away: a channel in which the flare is negative, as colours beyond the gamut are,
// stays what it is. So do samples that are not finite.
void add_flare(Image& rgb, const Image& flare);

}  // namespace contrejour::params
