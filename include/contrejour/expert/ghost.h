// SPDX-License-Identifier: Apache-2.0
// A lens's ghosts: their enumeration, their flux, and the selection of those to render. Source: hullin2011 4.1
// (enumeration), 4.2 (aperture culling, intensity LOD).
// Thread-safety: pure functions.
#pragma once

#include <memory>
#include <variant>
#include <vector>

#include "contrejour/expert/trace.h"
#include "contrejour/export.h"
#include "contrejour/lens.h"

namespace contrejour {

enum class GhostScope {
  OneSideOfStop,  // the stop is crossed once (both reflections on one side of it), as in both papers. The other ghosts
                  // carry up to half of the flux of all ghosts.
  All,  // every pair, the iris acting at every crossing, as in a real lens
};

enum class Reflections {
  Two,
  UpToFour,  // also ghosts of four, about (n / 2)^2 times as many; without those that cross the stop five times
};

// Ordered by (i, j, k, l, order). The stop never reflects; a sensor that is a grating reflects in all its orders.
[[nodiscard]] CONTREJOUR_API std::vector<Ghost> enumerate_ghosts(const LensState& lens, GhostScope scope,
                                                                 Reflections reflections = Reflections::Two);

// True if any ghost reflects at this surface, 1-based.
[[nodiscard]] CONTREJOUR_API bool reflects_at(const LensState& lens, int surface);

// True if the lens has this ghost in the widest scope.
[[nodiscard]] CONTREJOUR_API bool has_ghost(const LensState& lens, const Ghost& ghost);

struct SelectAll {};
struct SelectBrightest {
  int count = 0;
};
struct SelectByFlux {
  double drop_percent = 0;  // leaves out the weakest ghosts that together carry at most this part of the flux
};
struct SelectList {
  std::vector<Ghost> ghosts;
};
struct SelectSurface {
  int surface = 0;  // 1-based: ghosts that reflect there
};
using GhostSelection = std::variant<SelectAll, SelectBrightest, SelectByFlux, SelectList, SelectSurface>;

// A ghost for one light and wavelength.
struct GhostMeasure {
  double flux_mm2 = 0;  // integral over the entrance plane of cos(theta) * transmittance of unblocked rays, E0 = 1
  Vec2 centroid_mm;  // on the sensor, flux-weighted
  Vec2 min_mm, max_mm;  // footprint on the sensor
  double peak_per_mm2 = 0;  // largest irradiance over E0, as a mean over a pixel if its size was given
};

// Measures a lens's ghosts at one wavelength, by exact rays that are denser along the borders of the ghost's pupil.
// Fluxes are accurate to 1e-3, the direct image's to 5e-4, centroids and footprints to a hundredth of the footprint's
// size, peaks to a quarter. A meter is made once (tens of milliseconds for a long zoom), then used for any light, from
// any thread; a ghost takes a fifth of a millisecond, or a few milliseconds where rays fail.
class CONTREJOUR_API GhostMeter {
 public:
  GhostMeter(LensState lens, double lambda_nm);
  ~GhostMeter();
  GhostMeter(GhostMeter&&) noexcept;
  GhostMeter& operator=(GhostMeter&&) noexcept;

  // Flux of the direct image of a light, mm^2 at E0 = 1 (docs/physics/radiometry.md: Phi).
  [[nodiscard]] double direct_flux(const LightSource& light) const;

  // All zero when no light gets through. pixel_mm: side of the squares over which the peak is averaged; 0: the peak is
  // the mean of a cell of a mesh over the pupil, which limits the height of caustics.
  [[nodiscard]] GhostMeasure measure(Ghost ghost, const LightSource& light, double pixel_mm = 0.0) const;

 private:
  struct State;
  std::unique_ptr<const State> state_;
};

}  // namespace contrejour
