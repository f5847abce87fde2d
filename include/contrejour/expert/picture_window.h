// SPDX-License-Identifier: Apache-2.0
// A window of a picture or of a photograph's flare: lights, lens and ghosts are those of the whole, and only the
// window's pixels are rendered. They equal those of the whole picture to the method's error, since a method chooses its
// cells for the pixels that it draws; the window itself is the same, bit for bit, in every front end. Windows count
// from the picture's top left pixel. Errors: InvalidArgument for a window without pixels, or with pixels outside the
// picture. Thread-safety: pure functions.
#pragma once

#include "contrejour/expert/flare_plan.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/expert/requests.h"
#include "contrejour/export.h"
#include "contrejour/image.h"
#include "contrejour/image_io.h"
#include "contrejour/lens.h"
#include "contrejour/result.h"

namespace contrejour {

// values, lens: those of which the request or the plan was made; of a measured flare its ideal lens.
[[nodiscard]] CONTREJOUR_API Result<PictureRequest> window_of(PictureRequest request, const PixelWindow& window,
                                                              const params::Values& values, const LensState& lens);

// The plan of a photograph's lights, for the flare in a window of its data window. What was found stays as it is.
[[nodiscard]] CONTREJOUR_API Result<FlarePlan> window_of(FlarePlan plan, const PixelWindow& window,
                                                         const Picture& picture, const params::Values& values,
                                                         const LensState& lens);

// The pixels of a window that lies within the image.
[[nodiscard]] CONTREJOUR_API Image window_of(const Image& image, const PixelWindow& window);

}  // namespace contrejour
