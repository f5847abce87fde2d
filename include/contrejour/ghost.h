// Which ghosts a lens has, how bright they are, and which of them to render.
// Source: hullin2011 4.1 (enumeration), 4.2 (aperture culling, intensity LOD). Thread-safety: pure functions.
#pragma once

#include <variant>
#include <vector>

#include "contrejour/lens.h"
#include "contrejour/trace.h"

namespace contrejour {

enum class GhostScope {
  OneSideOfStop,  // both reflections on one side of the stop, crossed once: both papers' default
  All,            // every pair, the iris acting at every crossing
};

// Ordered by (i, j). The stop never reflects.
[[nodiscard]] std::vector<Ghost> enumerate_ghosts(const LensState& lens, GhostScope scope);

struct SelectAll {};
struct SelectBrightest {
  int count = 0;
};
struct SelectByFlux {
  double drop_percent = 0;  // the weakest ghosts that together carry at most this share are left out
};
struct SelectList {
  std::vector<Ghost> ghosts;
};
struct SelectSurface {
  int surface = 0;  // 1-based: ghosts that reflect there
};
using GhostSelection = std::variant<SelectAll, SelectBrightest, SelectByFlux, SelectList, SelectSurface>;

// A ghost for one light and wavelength, measured by a grid over the entrance window.
struct GhostMeasure {
  double flux_mm2 = 0;  // integral over the entrance plane of cos(theta) * transmission, unblocked, E0 = 1
  Vec2 centroid_mm;     // on the sensor, flux-weighted
  Vec2 min_mm, max_mm;  // footprint on the sensor
  Vec2 pupil_min_mm, pupil_max_mm;  // unblocked region of the entrance plane, enclosing
  double peak_per_mm2 = 0;          // largest irradiance of a grid cell over E0
};

// Flux of the direct image, mm^2 at E0 = 1 (DESIGN: Phi), of a light from this direction.
[[nodiscard]] double direct_flux(const LensState& lens, Vec3 direction, double lambda_nm);

[[nodiscard]] GhostMeasure measure_ghost(const LensState& lens, Ghost ghost, Vec3 direction, double lambda_nm);

}  // namespace contrejour
