// SPDX-License-Identifier: Apache-2.0
// Properties of each ghost of a lens for one light: flux, position, size, colour, focus. Fluxes are accurate to 1e-3,
// positions and sizes to a hundredth of the size, peaks to 25 per cent (50 next to rays that fail); see GhostMeter. The
// result is the same for any number of threads.
// Thread-safety: pure.
#pragma once

#include <optional>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/first_order.h"
#include "contrejour/expert/ghost.h"
#include "contrejour/export.h"
#include "contrejour/frame.h"
#include "contrejour/light.h"

namespace contrejour {

struct GhostFigures {
  Ghost ghost;
  Rgb rgb{};  // flux over the direct image's flux, per channel
  double relative_flux = 0;  // luminance of `rgb`
  double peak_irradiance = 0;  // largest mean irradiance over a pixel of the sensor, over the light's irradiance at the
                               // front
  double reflectance = 0;  // product of its surfaces' reflectances at normal incidence, by luminance
  Vec2 centroid_px, size_px;  // flux-weighted middle; sides of the box around its footprint
  Vec2 centroid_mm, size_mm;  // the same in sensor coordinates: right and up in the picture are negative
  GhostFirstOrder first_order;
  bool in_focus = false;  // its on-axis spot is at most kSharpBlur of the sensor's diagonal
  bool pupil_ghost = false;  // an image of the stop in the middle of the picture: its chief-ray image point moves at
                             // most kStillPosition times as far as the direct image
  static constexpr double kSharpBlur = 0.01, kStillPosition = 0.05;
};

struct FiguresRequest {
  Frame frame;
  Light light;  // its value does not matter
  GhostScope scope = GhostScope::All;
  Reflections reflections = Reflections::Two;
  std::vector<SpectralBand> bands;  // for a single wavelength use the weights 1, 1, 1
};

// In order of decreasing relative_flux. Errors: a light that is not in front of the lens, Cancelled.
[[nodiscard]] CONTREJOUR_API Result<std::vector<GhostFigures>> ghost_figures(const LensState& lens,
                                                                             const FiguresRequest& request,
                                                                             const Context& context);

}  // namespace contrejour
