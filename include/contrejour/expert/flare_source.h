// SPDX-License-Identifier: Apache-2.0
// The source of a flare: a configured lens, or a flare measured from photographs, which stands wherever a lens may.
// Points of a measured flare's sensor are tangents of angles: it belongs to an ideal lens without distortion of a focal
// length of 1 mm. A light's value is the sum of its direct image, as everywhere (docs/physics/radiometry.md).
// Errors: InvalidArgument, Cancelled. Thread-safety: plain values, pure functions; the same bits for any number of
// threads.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "contrejour/expert/flare_layers.h"
#include "contrejour/expert/measured_flare.h"
#include "contrejour/export.h"
#include "contrejour/frame.h"
#include "contrejour/frame_settings.h"
#include "contrejour/lens.h"
#include "contrejour/light.h"
#include "contrejour/render.h"
#include "contrejour/result.h"

namespace contrejour {

using FlareSource = std::variant<LensState, MeasuredFlare>;

// Whether a name is that of a measured flare's file: it ends in ".flare.toml", in any case.
[[nodiscard]] CONTREJOUR_API bool is_measured_flare(std::string_view name);

// The ideal lens: focal length 1 mm, no surfaces, the photographs' field as its sensor (0 x 0 where it is unknown).
// direction_for_image_point() and chief_ray_image_point() of trace.h know such lenses, renderers do not.
[[nodiscard]] CONTREJOUR_API LensState ideal_lens_of(const MeasuredFlare& flare);

// The error where neither that file nor the user states the field of a picture.
[[nodiscard]] CONTREJOUR_API Error unknown_field(const MeasuredFlare& flare);

// The lens of a source: its own, or the ideal one. Its name, focal length and sensor are meaningful for both.
[[nodiscard]] CONTREJOUR_API LensState geometry_of(const FlareSource& source);

// The flare of lights by their directions, which counts as that of distant lights. frame: of the ideal lens. Errors:
// those of render_measured(); a light that is not in front of the camera, or has a size; a frame whose pixels have no
// size, because neither the file nor the caller states the field.
[[nodiscard]] CONTREJOUR_API Result<Flare> render(const MeasuredFlare& flare, std::span<const Light> lights,
                                                  const Frame& frame, const Context& context = {});

// The same in layers (flare_layers.h): by light; by ghost, named as in the file, the brightest of this frame first; by
// part, which is one layer. Errors: also layers by surface, or a list of ghosts.
[[nodiscard]] CONTREJOUR_API Result<LayeredFlare> render_layers(const MeasuredFlare& flare,
                                                                std::span<const Light> lights, const Frame& frame,
                                                                const LayerOptions& options,
                                                                const Context& context = {});

// The flare of either source. A measured flare takes the frame from the settings and ignores the rest.
[[nodiscard]] CONTREJOUR_API Result<Flare> render(const MethodOptions& method, const FlareSource& source,
                                                  std::span<const Light> lights, const FrameSettings& settings,
                                                  const Context& context = {});

// For the user: each light beyond the measured angles, and how much of its flare is left there.
[[nodiscard]] CONTREJOUR_API std::vector<std::string> range_warnings(const MeasuredFlare& flare,
                                                                     std::span<const Light> lights);

}  // namespace contrejour
