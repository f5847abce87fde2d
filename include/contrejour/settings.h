// Converts a user's values to the library's types: lens settings, frame, lights, a method's options, frame and
// detection settings. Angles are converted from the table's degrees to radians; lengths are in mm, wavelengths in nm.
// Errors: InvalidArgument; Io, Parse and Unsupported for files that a value names. Thread-safety: pure functions, which
// may read such files.
#pragma once

#include <string_view>
#include <vector>

#include "contrejour/lens.h"
#include "contrejour/light.h"
#include "contrejour/light_detection.h"
#include "contrejour/parameter_text.h"
#include "contrejour/parameter_values.h"
#include "contrejour/render.h"

namespace contrejour::params {

inline constexpr double kDegree_rad = 0.017453292519943295;

// Errors: a picture of the iris or of dirt that cannot be read or used.
[[nodiscard]] Result<LensSettings> lens_settings(const Values& values);

// The lens configured by --sensor and the lens's settings. Errors: those of lens_settings() and configure_lens().
[[nodiscard]] Result<LensState> lens_of(Prescription lens, const Values& values);

// The pitch of a whole frame with these numbers of square pixels, across and down: it fits the lens's sensor, or has
// the field of view of --hfov.
[[nodiscard]] double pixel_pitch_mm(const Values& values, const LensState& lens, Vec2 square_pixels);

// The whole frame of this size in pixels.
[[nodiscard]] Frame whole_frame(const Values& values, const LensState& lens, PixelSize size);

[[nodiscard]] GhostScope ghost_scope(const Values& values);
[[nodiscard]] Reflections reflections(const Values& values);

[[nodiscard]] ColourSpace colour_space(const Values& values, ColourSpace otherwise);
[[nodiscard]] FrameSettings frame_settings(const Values& values, const Frame& frame, ColourSpace space);

// The options of the method that --method names, or of another one. Errors: there is no such method.
[[nodiscard]] MethodOptions method_options(const Values& values);
[[nodiscard]] Result<MethodOptions> method_options(const Values& values, std::string_view method);

[[nodiscard]] AdaptiveOptions adaptive_options(const Values& values);
[[nodiscard]] BundleOptions bundle_options(const Values& values);
[[nodiscard]] TiledOptions tiled_options(const Values& values);
[[nodiscard]] ReferenceOptions reference_options(const Values& values);

// The given lights, each with its own value and colour or the common ones; if there are none, one light at u, v = 0.70,
// 0.33. Errors: a light that is not in front of the camera; R,G,B given for both value and colour.
[[nodiscard]] Result<std::vector<Light>> lights(const Values& values, const LensState& lens, const Frame& frame,
                                                ColourSpace space);

// As lights(), but empty if no light is given.
[[nodiscard]] Result<std::vector<Light>> given_lights(const Values& values, const LensState& lens, const Frame& frame,
                                                      ColourSpace space);

// The factor on the lights of `apply`: --gain and --stops.
[[nodiscard]] double gain(const Values& values);

// Without regions, which depend on the picture (flare_plan.h).
[[nodiscard]] DetectionSettings detection_settings(const Values& values);

}  // namespace contrejour::params
