// SPDX-License-Identifier: Apache-2.0
// Converts a user's values to the library's types: lens settings, frame, lights, a method's options, frame and
// detection settings. Angles are converted from the table's degrees to radians; lengths are in mm, wavelengths in nm.
// Errors: InvalidArgument; Io, Parse and Unsupported for files that a value names. Thread-safety: pure functions, which
// may read such files.
#pragma once

#include <string_view>
#include <vector>

#include "contrejour/expert/light_detection.h"
#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/export.h"
#include "contrejour/lens.h"
#include "contrejour/light.h"
#include "contrejour/render.h"

namespace contrejour::params {

inline constexpr double kDegree_rad = 0.017453292519943295;

// Errors: a picture of the iris or of dirt that cannot be read or used.
[[nodiscard]] CONTREJOUR_API Result<LensSettings> lens_settings(const Values& values);

// The lens with the size of --sensor, if that is given.
[[nodiscard]] CONTREJOUR_API Prescription with_sensor(Prescription lens, const Values& values);

// The lens configured by --sensor and the lens's settings. Errors: those of lens_settings() and configure_lens().
[[nodiscard]] CONTREJOUR_API Result<LensState> lens_of(Prescription lens, const Values& values);

// The pitch of a whole frame with these numbers of square pixels, across and down: it fits the lens's sensor, or has
// the field of view of --hfov.
[[nodiscard]] CONTREJOUR_API double pixel_pitch_mm(const Values& values, const LensState& lens, Vec2 square_pixels);

// The whole frame of this size in pixels.
[[nodiscard]] CONTREJOUR_API Frame whole_frame(const Values& values, const LensState& lens, PixelSize size);

[[nodiscard]] CONTREJOUR_API GhostScope ghost_scope(const Values& values);
[[nodiscard]] CONTREJOUR_API Reflections reflections(const Values& values);

[[nodiscard]] CONTREJOUR_API ColourSpace colour_space(const Values& values, ColourSpace otherwise);
[[nodiscard]] CONTREJOUR_API FrameSettings frame_settings(const Values& values, const Frame& frame, ColourSpace space);

// The options of the method that --method names, or of another one. Errors: there is no such method.
[[nodiscard]] CONTREJOUR_API MethodOptions method_options(const Values& values);
[[nodiscard]] CONTREJOUR_API Result<MethodOptions> method_options(const Values& values, std::string_view method);

[[nodiscard]] CONTREJOUR_API AdaptiveOptions adaptive_options(const Values& values);
[[nodiscard]] CONTREJOUR_API BundleOptions bundle_options(const Values& values);
[[nodiscard]] CONTREJOUR_API TiledOptions tiled_options(const Values& values);
[[nodiscard]] CONTREJOUR_API ReferenceOptions reference_options(const Values& values);

// The given lights, each with its own value and colour or the common ones; if there are none, one light at u, v = 0.70,
// 0.33. Errors: a light that is not in front of the camera; R,G,B given for both value and colour.
[[nodiscard]] CONTREJOUR_API Result<std::vector<Light>> lights(const Values& values, const LensState& lens,
                                                               const Frame& frame, ColourSpace space);

// As lights(), but empty if no light is given.
[[nodiscard]] CONTREJOUR_API Result<std::vector<Light>> given_lights(const Values& values, const LensState& lens,
                                                                     const Frame& frame, ColourSpace space);

// The factor on the lights of `apply`: --gain and --stops.
[[nodiscard]] CONTREJOUR_API double gain(const Values& values);

// Without regions, which depend on the picture (flare_plan.h).
[[nodiscard]] CONTREJOUR_API DetectionSettings detection_settings(const Values& values);

}  // namespace contrejour::params
