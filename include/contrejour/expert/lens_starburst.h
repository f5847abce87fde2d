// SPDX-License-Identifier: Apache-2.0
// A light's starburst through a lens: the exit pupil as seen from the light's image, vignetted and foreshortened, and
// its diffraction pattern. Its centre is the chief-ray image point (chief_ray_image_point, Frame::pixel_from_sensor).
// Accuracy: borders of the pupil to 1e-3 of the stop's radius at the traced wavelength (4e-3 wide open in the corner);
// the pupil's shape and position are assumed equal at all wavelengths, the transmittance is each wavelength's own
// (docs/physics/diffraction.md). Errors: InvalidArgument, Cancelled. Thread-safety: pure functions; results do not
// depend on the threads.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "contrejour/expert/starburst.h"
#include "contrejour/expert/trace.h"
#include "contrejour/export.h"
#include "contrejour/lens.h"

namespace contrejour {

// The rays of a light that reach its image, by their direction cosines x and y at the sensor. The cosines determine the
// pattern: the wave from cosines k has the phase 2 pi k.x / lambda at x. In a plane of mm they are the exit pupil as if
// it stood 1 mm from the sensor: radius 1 / (2 N) on the axis.
struct ExitPupil {
  PupilMask mask;  // amplitude: square root of the flux per solid cosine; its mean over the area is 1, less half-tones
  std::optional<PupilOutline>
      outline;  // the iris, clipped by the rims that vignette it; none if that differs from the mask, or for a picture
  double radius = 0;  // of the circle about the mask's middle that contains the pupil; 0: no light gets through
  Vec2 middle;  // the cosines of the mask's middle
  double flux_mm2 = 0;  // of the direct image at E0 = 1: GhostMeter::direct_flux without what dirt blocks
  double open_fraction = 1;  // fraction of the flux that dirt transmits
  double fit_error = 0;  // largest error of the borders, relative to the stop's or rim's radius, at traced rays that
                         // were not fitted
  std::vector<Vec3> rays_mm;  // points in front of the lens of some rays that get through, evenly spread
};

[[nodiscard]] CONTREJOUR_API Result<ExitPupil> exit_pupil(const LensState& lens, const LightSource& light,
                                                          double lambda_nm, int samples_across = 510,
                                                          const Context& context = {});

struct LensStarburstSettings {
  double pixel_pitch_mm = 0.01;
  double radius_px = 1200.0;  // the distance from its centre up to which it is drawn
};

// bands: spectral_bands of the light, 100 and more. The lens's transmittance of each is applied here; the whole plane
// still sums to 1 in each channel, or to the fraction that dirt transmits. If no light gets through, the starburst
// draws nothing.
[[nodiscard]] CONTREJOUR_API Result<Starburst> lens_starburst(const LensState& lens, const LightSource& light,
                                                              std::span<const SpectralBand> bands,
                                                              const LensStarburstSettings& settings,
                                                              const Context& context = {});

}  // namespace contrejour
