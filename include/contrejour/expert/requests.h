// SPDX-License-Identifier: Apache-2.0
// Requests of a front end for a user's values (parameter_values.h): the picture that `contrejour render` draws, the
// ghosts that `contrejour ghosts` lists, the lights that `contrejour apply` finds. A front end that goes this way gets
// the command line's results, bit for bit. Errors: InvalidArgument; Io, Parse and Unsupported for files
// that a value names. Thread-safety: pure functions, but for the renderer and the pixels that they write.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/light_detection.h"
#include "contrejour/expert/measured_flare.h"
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
// another one (pixel_grid.h). Renderers of either kind of source draw it (source_renderer.h).
struct PictureRequest {
  PixelGrid grid;
  double pixel_aspect = 1.0;  // of the picture's pixels as displayed
  std::vector<Light> lights;
  FrameSettings settings;
  std::vector<std::string> warnings;  // for the user: lights beyond a measured flare's angles
};

// The lights of a picture to which neither the caller nor the values give any: the one of params::lights(), or none.
enum class WithoutLights { DefaultLight, Dark };

// The picture of --size. Its lights are `lights`, then those of the values.
[[nodiscard]] CONTREJOUR_API Result<PictureRequest> picture_request(
    const params::Values& values, const LensState& lens, std::span<const Light> lights = {},
    WithoutLights without = WithoutLights::DefaultLight);
// The same of a measured flare, with the lights in the exposure that the values state. Errors: also those of
// check_measured_values().
[[nodiscard]] CONTREJOUR_API Result<PictureRequest> picture_request(
    const params::Values& values, const MeasuredFlare& flare, std::span<const Light> lights = {},
    WithoutLights without = WithoutLights::DefaultLight);

// Renders it by a renderer that has the lens and the method. Errors: also a flare that is not finite; Cancelled.
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
