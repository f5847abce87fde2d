// SPDX-License-Identifier: Apache-2.0
// Requests of a front end for a user's values (parameter_values.h): the picture that `contrejour render` draws, the
// ghosts that `contrejour ghosts` lists, the lights that `contrejour apply` finds. A front end that goes this way gets
// the command line's results, bit for bit. Errors: InvalidArgument; Io, Parse and Unsupported for files
// that a value names; Cancelled. Thread-safety: pure functions, but for the renderer and the pixels that they write.
#pragma once

#include <span>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/light_detection.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/expert/pixel_grid.h"
#include "contrejour/expert/render_statistics.h"
#include "contrejour/export.h"
#include "contrejour/frame_settings.h"
#include "contrejour/ghost_figures.h"
#include "contrejour/image_view.h"
#include "contrejour/lens.h"
#include "contrejour/light.h"
#include "contrejour/render.h"
#include "contrejour/renderer.h"

namespace contrejour {

// A picture of grid.width x grid.height pixels. Where its pixels are not square on the sensor, the rendered frame is
// another one (pixel_grid.h).
struct PictureRequest {
  PixelGrid grid;
  std::vector<Light> lights;
  FrameSettings settings;
};

// The picture of --size. Its lights are `lights`, then those of the values; without any, the one of params::lights().
[[nodiscard]] CONTREJOUR_API Result<PictureRequest> picture_request(const params::Values& values, const LensState& lens,
                                                                    std::span<const Light> lights = {});

// Renders it by a renderer that has the lens and the method. Errors: also a flare that is not finite.
[[nodiscard]] CONTREJOUR_API Result<Flare> render_picture(const PictureRequest& request, Renderer& renderer,
                                                          const Context& context = {});
// The same into a caller's pixels, which square pixels reach without a copy.
[[nodiscard]] CONTREJOUR_API Result<RenderStatistics> render_picture(const PictureRequest& request, Renderer& renderer,
                                                                     const ImageView& pixels,
                                                                     const Context& context = {});

// For one light: the given one, or else the first of the values, or else that of params::lights().
[[nodiscard]] CONTREJOUR_API Result<FiguresRequest> figures_request(const params::Values& values, const LensState& lens,
                                                                    const Light* light = nullptr);

// detect_lights() with the values' settings, their regions included.
[[nodiscard]] CONTREJOUR_API Result<Detection> detect_lights(const Image& rgb, const params::Values& values);

}  // namespace contrejour
