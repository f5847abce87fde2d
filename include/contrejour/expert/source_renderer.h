// SPDX-License-Identifier: Apache-2.0
// The renderer of a flare source (flare_source.h): that of a lens, or a measured flare, which needs none. Front ends
// draw every picture and every photograph by it, so that a measured flare stands wherever a lens may. Errors: those of
// renderer.h, flare_source.h and measured_settings.h. Thread-safety: as of a Renderer.
#pragma once

#include <span>
#include <string>
#include <variant>

#include "contrejour/apply.h"
#include "contrejour/expert/flare_source.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/expert/picture_layers.h"
#include "contrejour/expert/requests.h"
#include "contrejour/export.h"
#include "contrejour/renderer.h"

namespace contrejour {

using SourceRenderer = std::variant<Renderer, MeasuredFlare>;

// A renderer that has the lens and the values' method, or the measured flare.
[[nodiscard]] CONTREJOUR_API Result<SourceRenderer> renderer_of(const params::Values& values,
                                                                const FlareSource& source);

// The same again, for frames that another thread draws at the same time (Renderer::another).
[[nodiscard]] CONTREJOUR_API Result<SourceRenderer> another(const SourceRenderer& renderer);

// Whether a device draws the frames (Renderer::has_device); it draws no measured flare.
[[nodiscard]] CONTREJOUR_API bool has_device(const SourceRenderer& renderer);

// Why the CPU renders although another device was asked for; empty: it does not (Renderer::device_note).
[[nodiscard]] CONTREJOUR_API std::string device_note(const SourceRenderer& renderer);

// The flare of lights in a frame; a measured flare takes the settings' frame and ignores the rest.
[[nodiscard]] CONTREJOUR_API Result<Flare> render(SourceRenderer& renderer, std::span<const Light> lights,
                                                  const FrameSettings& settings, const Context& context = {});

// A request (requests.h) as a picture, into a caller's pixels, and in layers.
[[nodiscard]] CONTREJOUR_API Result<Flare> render_picture(const PictureRequest& request, SourceRenderer& renderer,
                                                          const Context& context = {});
[[nodiscard]] CONTREJOUR_API Result<RenderStatistics> render_picture(const PictureRequest& request,
                                                                     SourceRenderer& renderer, const ImageView& pixels,
                                                                     const Context& context = {});
[[nodiscard]] CONTREJOUR_API Result<LayeredFlare> render_picture_layers(const PictureRequest& request,
                                                                        SourceRenderer& renderer,
                                                                        const LayerOptions& options,
                                                                        const Context& context = {});

// A photograph's flare (apply.h), by either. Lights beyond a measured flare's angles are warnings of the plan.
[[nodiscard]] CONTREJOUR_API Result<PictureFlare> render_flare(FlarePlan& plan, const Image& rgb,
                                                               const params::Values& values, SourceRenderer& renderer,
                                                               const Context& context = {});
[[nodiscard]] CONTREJOUR_API Result<PictureLayers> render_flare_layers(FlarePlan& plan, const Image& rgb,
                                                                       const params::Values& values,
                                                                       SourceRenderer& renderer,
                                                                       const LayerOptions& options,
                                                                       const Context& context = {});

// All steps of apply.h in one call. Errors: also values that a measured flare cannot follow.
[[nodiscard]] CONTREJOUR_API Result<AppliedFlare> apply_flare(Picture& picture, const FlareSource& source,
                                                              const params::Values& values,
                                                              const Context& context = {});

}  // namespace contrejour
