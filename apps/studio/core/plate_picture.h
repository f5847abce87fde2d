// SPDX-License-Identifier: Apache-2.0
// A plate with its flare: the picture of `contrejour apply`, bit for bit, and drafts of it, for which the plate is
// reduced. Thread-safety: a plain class, one thread at a time.
#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/expert/plate.h"
#include "contrejour/image.h"
#include "contrejour/lens.h"
#include "contrejour/renderer.h"
#include "studio/core/still_lights.h"

namespace contrejour::studio {

class PlatePictures {
 public:
  struct Picture {
    Image image;  // the plate with the flare
    int ghosts = 0;
  };

  // The renderer has the lens and the method. Errors: those of plan_flare and render_flare.
  [[nodiscard]] static Result<Picture> refined(const Plate& plate, const LensState& lens, const params::Values& values,
                                               Renderer& renderer, const Context& context);

  // By values whose size is the plate's over a divisor. draw: the flare, whose pixels are still sums over their areas.
  // Errors: also those of picture_request and `draw`.
  [[nodiscard]] Result<Picture> draft(const std::shared_ptr<const Plate>& plate, const LensState& lens,
                                      const params::Values& values, const DrawFlare& draw);

 private:
  [[nodiscard]] Result<std::vector<Light>> detected(const Plate& plate, const LensState& lens,
                                                    const params::Values& values);
  [[nodiscard]] const Image& reduced(int width, int height);

  std::shared_ptr<const Plate> plate_;  // that what follows is of
  std::map<std::pair<int, int>, Image> reduced_;
  std::string detected_with_;  // the settings of the detection kept
  std::vector<Light> detected_;
};

// The means of an image over as many rectangles of whole pixels, about as large as each other.
[[nodiscard]] Image reduced_image(const Image& image, int width, int height);

}  // namespace contrejour::studio
