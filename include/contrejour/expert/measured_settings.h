// SPDX-License-Identifier: Apache-2.0
// A user's values with a measured flare in place of a lens: which of them have a meaning, and walch2018's equation 2.
// plan_flare() (flare_plan.h) and pixel_grid() take the ideal lens of the flare (flare_source.h).
// Errors: InvalidArgument. Thread-safety: pure functions.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "contrejour/apply.h"
#include "contrejour/expert/flare_source.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/expert/picture_layers.h"
#include "contrejour/export.h"

namespace contrejour {

// The lights that a flare is drawn for: given ones, or also those of a photograph, whose exposure they are in already.
enum class MeasuredUse { Lights, Photograph };

// Errors: a value for an option that a measured flare cannot follow, such as the lens's focal length, iris, coatings or
// ghosts, unless it is that option's default; an exposure for a photograph; no field, in the file or the values.
[[nodiscard]] CONTREJOUR_API Result<void> check_measured_values(const MeasuredFlare& flare,
                                                                const params::Values& values, MeasuredUse use);

// By how much the flare is brighter in a picture of the given f-number, sensitivity and exposure time than in the
// photographs (walch2018 eq. 2): 1 if none of the three is given, and what is not given is as in the photographs. The
// values of lights then refer to the photographs' exposure. Errors: the file does not state its exposure.
[[nodiscard]] CONTREJOUR_API Result<double> exposure_scale(const MeasuredFlare& flare, const params::Values& values);

// The same lights in the exposure that the values state, by exposure_scale().
[[nodiscard]] CONTREJOUR_API Result<std::vector<Light>> exposed_lights(const MeasuredFlare& flare,
                                                                       std::vector<Light> lights,
                                                                       const params::Values& values);

// As render_flare() in apply.h, of a measured flare: each light is drawn as a point.
[[nodiscard]] CONTREJOUR_API Result<PictureFlare> render_flare(const FlarePlan& plan, const Image& rgb,
                                                               const MeasuredFlare& flare, const Context& context = {});

// As render_flare_layers() in picture_layers.h, of a measured flare.
[[nodiscard]] CONTREJOUR_API Result<PictureLayers> render_flare_layers(const FlarePlan& plan, const Image& rgb,
                                                                       const MeasuredFlare& flare,
                                                                       const LayerOptions& options,
                                                                       const Context& context = {});

}  // namespace contrejour
