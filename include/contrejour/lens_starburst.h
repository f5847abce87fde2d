// A light's starburst through a lens: the exit pupil as the light's own image sees it, vignetted and askew, and its
// diffraction pattern. Where the chief ray lands is its centre (landing_of, Frame::pixel_from_sensor).
// Accuracy: borders of the pupil to 1e-3 of the stop's radius at the traced wavelength (4e-3 wide open in the corner);
// the pupil's shape and place are taken as the same at all others, the transmission is each wavelength's own
// (docs/physics/diffraction.md). Errors: InvalidArgument, Cancelled. Thread-safety: pure functions; results do not
// depend on the threads.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "contrejour/lens.h"
#include "contrejour/starburst.h"
#include "contrejour/trace.h"

namespace contrejour {

// The rays of a light that reach its image, by their direction cosines x and y at the sensor. These are what
// makes the pattern: the wave from cosines k has the phase 2 pi k.x / lambda at x. In a plane of mm they are the exit
// pupil as if it stood 1 mm from the sensor: radius 1 / (2 N) on the axis.
struct ExitPupil {
  PupilMask mask;  // amplitude: square root of the flux per solid cosine; its mean over the area is 1, less half-tones
  std::optional<PupilOutline>
      outline;  // the iris, cut by the rims that vignette it; none where that differs from the mask, or for a picture
  double radius = 0;  // of the circle about the middle of the mask that holds the pupil; 0: no light gets through
  Vec2 middle;  // the cosines of the mask's middle
  double flux_mm2 = 0;  // of the direct image at E0 = 1, as GhostMeter::direct_flux less what dirt blocks
  double open_share = 1;  // of the flux, that dirt lets through
  double fit_error = 0;  // largest, of the stop's or a rim's radius, at traced rays that the borders were not fitted to
  std::vector<Vec3> rays_mm;  // points in front of the lens of some rays that get through, evenly spread
};

[[nodiscard]] Result<ExitPupil> exit_pupil(const LensState& lens, const LightSource& light, double lambda_nm,
                                           int samples_across = 510, const Context& context = {});

struct LensStarburstSettings {
  double pixel_pitch_mm = 0.01;
  double radius_px = 1200.0;  // drawn so far from its centre
};

// bands: spectral_bands of the light, 100 and more. What the lens transmits of each is seen to here; of each channel
// the whole plane still sums to 1, or to what dirt lets through of that. A light that does not get through has a
// starburst that draws nothing.
[[nodiscard]] Result<Starburst> lens_starburst(const LensState& lens, const LightSource& light,
                                               std::span<const SpectralBand> bands,
                                               const LensStarburstSettings& settings, const Context& context = {});

}  // namespace contrejour
