// A user's values -> what the library takes: lens settings, frame, lights, a method's options, frame and detection
// settings. Angles, which the table has in degrees, are in radians there; lengths are in mm, wavelengths in nm.
// Errors: InvalidArgument; Io, Parse and Unsupported of files that a value names. Thread-safety: pure functions, which
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

// Errors: a picture of the iris or of dirt that cannot be read or is none.
[[nodiscard]] Result<LensSettings> lens_settings(const Values& values);

// The lens as --sensor and the lens's settings have it. Errors: those of lens_settings() and configure_lens().
[[nodiscard]] Result<LensState> lens_of(Prescription lens, const Values& values);

// The pitch of a whole frame of so many square pixels, across and down: on the lens's sensor, or as wide as --hfov
// says.
[[nodiscard]] double pixel_pitch_mm(const Values& values, const LensState& lens, Vec2 square_pixels);

// A whole frame of these pixels.
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

// The lights given, each with its own value and colour or the common ones; none given: one at u, v = 0.70, 0.33.
// Errors: a light beside or behind the camera; R,G,B given for both value and colour.
[[nodiscard]] Result<std::vector<Light>> lights(const Values& values, const LensState& lens, const Frame& frame,
                                                ColourSpace space);

// The same without the usual one: nothing where none is given.
[[nodiscard]] Result<std::vector<Light>> given_lights(const Values& values, const LensState& lens, const Frame& frame,
                                                      ColourSpace space);

// What apply multiplies lights by: --gain and --stops.
[[nodiscard]] double gain(const Values& values);

// Regions are left out: they need the picture (flare_plan.h).
[[nodiscard]] DetectionSettings detection_settings(const Values& values);

}  // namespace contrejour::params
