// Figures of each ghost of a lens for one light: how bright, where, how large, what colour, where it focuses.
// Fluxes are good to 1e-3 (GhostMeter). Same result for any thread count. Thread-safety: pure.
#pragma once

#include <optional>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/frame.h"
#include "contrejour/ghost.h"
#include "contrejour/light.h"

namespace contrejour {

struct GhostFigures {
  Ghost ghost;
  Rgb rgb{};                    // flux over the direct image's flux, per channel
  double relative_flux = 0;     // their luminance
  double peak_irradiance = 0;   // largest irradiance on the sensor over that of the light at the front of the lens
  Vec2 centroid_px;             // flux-weighted
  Vec2 size_px;                 // of the box around its footprint
  std::optional<double> paraxial_focus_mm;  // sensor -> focus of the ghost's near-axis light, positive behind it
};

struct FiguresRequest {
  Frame frame;
  Light light;                      // its value does not matter
  GhostScope scope = GhostScope::OneSideOfStop;
  Reflections reflections = Reflections::Two;
  std::vector<SpectralBand> bands;  // weights of one wavelength: 1, 1, 1
};

// By falling relative_flux. Errors: a light that is not in front of the lens, Cancelled.
[[nodiscard]] Result<std::vector<GhostFigures>> ghost_figures(const LensState& lens, const FiguresRequest& request,
                                                              const Context& context);

}  // namespace contrejour
