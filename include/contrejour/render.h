// SPDX-License-Identifier: Apache-2.0
// Renders a flare and its statistics from a method's options, a lens state, lights and a frame's settings. The image
// contains what the flare adds to the photograph, in the lights' own units (docs/physics/radiometry.md): a light whose
// direct image sums to V makes a ghost pixel of V * E_ghost * A_pixel / Phi. It does not contain the lights' direct
// images, unless settings.starburst is on. Channels may be slightly negative where a ghost's colour lies outside the
// RGB gamut.
// Errors: InvalidArgument, Cancelled. The result is the same for any number of threads. Thread-safety: pure functions.
#pragma once

#include <span>
#include <string_view>

#include "contrejour/context.h"
#include "contrejour/expert/methods.h"
#include "contrejour/expert/render_statistics.h"
#include "contrejour/export.h"
#include "contrejour/frame_settings.h"
#include "contrejour/image.h"
#include "contrejour/lens.h"
#include "contrejour/light.h"
#include "contrejour/method_options.h"

namespace contrejour {

struct Flare {
  Image image;  // RGB, the pixels of settings.frame
  RenderStatistics statistics;
};

[[nodiscard]] CONTREJOUR_API Result<Flare> render(const MethodOptions& method, const LensState& lens,
                                                  std::span<const Light> lights, const FrameSettings& settings,
                                                  const Context& context = {});

// Renders by a method's name, with its default options. Errors: also InvalidArgument if there is no such method.
[[nodiscard]] CONTREJOUR_API Result<Flare> render(std::string_view method, const LensState& lens,
                                                  std::span<const Light> lights, const FrameSettings& settings,
                                                  const Context& context = {});

}  // namespace contrejour
