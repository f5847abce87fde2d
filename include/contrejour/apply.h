// SPDX-License-Identifier: Apache-2.0
// Adds to a photograph the flare of its own lights: what `contrejour apply` does, for pixels in memory.
// A host fills in a Picture's rgb (scene-linear, white at 1) and its two windows, or takes picture_of(image); values
// contain the user's settings (parameter.h). After an error everything is unchanged. The result is the same for any
// number of threads. Thread-safety: pure functions, which may read files that a value names.
#pragma once

#include "contrejour/context.h"
#include "contrejour/expert/flare_plan.h"
#include "contrejour/expert/flare_visibility.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/export.h"
#include "contrejour/image.h"
#include "contrejour/image_io.h"
#include "contrejour/lens.h"
#include "contrejour/render.h"
#include "contrejour/renderer.h"
#include "contrejour/result.h"

namespace contrejour {

// A flare as large as the photograph: RGB, zeros where there are no lights.
struct PictureFlare {
  Image image;
  RenderStatistics statistics;  // empty where there are no lights
  FlareVisibility visibility;   // relative to the photograph without it
};

// Renders the flare of a plan's lights by the values' method. `rgb` is the photograph for which the plan was made,
// without flare. The number of threads is the context's. Errors: those of render(); InvalidArgument for a flare with
// samples that are not finite.
[[nodiscard]] CONTREJOUR_API Result<PictureFlare> render_flare(const FlarePlan& plan, const Image& rgb,
                                                               const LensState& lens, const params::Values& values,
                                                               const Context& context = {});

// The same by a renderer that lives from frame to frame. It has the lens and the method for which the plan was made;
// the values give all other settings.
[[nodiscard]] CONTREJOUR_API Result<PictureFlare> render_flare(const FlarePlan& plan, const Image& rgb,
                                                               const params::Values& values, Renderer& renderer,
                                                               const Context& context = {});

// Adds a flare of the same size to the first three channels of an image, and never subtracts: where a channel of the
// flare is negative, as for colours outside the gamut, the sample is unchanged. Samples that are not finite are
// unchanged, and so is alpha.
CONTREJOUR_API void add_flare(Image& image, const Image& flare);

struct AppliedFlare {
  FlarePlan plan;  // the lights, where they were found, and warnings
  PictureFlare flare;
};

// All steps in one call: finds the photograph's lights, renders their flare and adds it to picture.rgb; nothing else of
// the picture changes. Errors: those of plan_flare and render_flare.
[[nodiscard]] CONTREJOUR_API Result<AppliedFlare> apply_flare(Picture& picture, const LensState& lens,
                                                              const params::Values& values,
                                                              const Context& context = {});

}  // namespace contrejour
