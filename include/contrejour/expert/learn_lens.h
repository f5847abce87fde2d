// SPDX-License-Identifier: Apache-2.0
// Properties of a lens of known prescription, learnt from photographs of a sweep: the reflectances of its surfaces from
// the energies of its ghosts, and its focus, spacings, tilts and decentres from their places and sizes.
// Source: docs/physics/measured-flare.md, "Physics from pictures".
// Units: as in lens.h; reflectances 0 to 1. Errors: InvalidArgument, Cancelled, those of the pictures and of
// configure_lens. Thread-safety: pure functions; the same bits for any number of threads.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/colour.h"
#include "contrejour/expert/fit_flare.h"
#include "contrejour/expert/ghost_id.h"
#include "contrejour/expert/sweep_geometry.h"
#include "contrejour/export.h"
#include "contrejour/lens.h"
#include "contrejour/result.h"

namespace contrejour {

// A sweep of a known lens.
struct LensPhotographs {
  Prescription lens;  // as its file has it: what is learnt starts from there
  LensSettings settings;  // zoom, f-number, focus and iris of the photographs
  FlareSweep sweep;
  SweepGeometry geometry;
  double source_radius_rad = 0.00436;  // 0.5 degrees across
  Spectrum spectrum = IlluminantD65{};
  double pixel_pitch_mm = 0;  // of the pictures; 0: they show the lens's whole sensor
};

struct CoatingFitOptions {
  int max_width = 320;  // pictures are reduced by whole numbers to at most this width
  int max_ghosts = 40;  // whose energies are measured: the brightest; all others together are one picture more
  // Ghosts are drawn again with the coatings learnt, for their transmittances and, from the third round on, colours.
  int max_rounds = 5;
  double model_error = 0.05;  // of a pixel's value: what a drawn ghost is not expected to describe
};

// A ghost in the pictures.
struct GhostEnergy {
  Ghost ghost;
  // Its energy over that of the lens as it is written, in the channels of ACEScg, the mean of all angles; 0: none is
  // seen.
  Rgb ratio{};
  Rgb error{};  // standard error of the ratio; 0: the ghost reaches no picture
};

struct LearntReflectance {
  int surface = 0;  // 1-based
  bool learnt = false;  // false: cemented, or without power to reflect: it keeps its coating
  Rgb reflectance{};  // at normal incidence, the mean over each channel of the light in ACEScg
  Rgb relative_error{};  // standard errors, or the last round's change if that is larger
  std::array<bool, 3> determined{};  // false: the ghosts leave it, or its ratio to others, open
};

struct LearntCoatings {
  Prescription lens;  // with a tabulated coating at each surface that was learnt
  std::vector<LearntReflectance> surfaces;  // those between glass and air
  std::vector<GhostEnergy> ghosts;  // by the lens as it was written
  std::array<int, 3> rank{};  // reflectances, or combinations of them, that the ghosts determine
  int unknowns = 0;
  // Pairs of ghosts whose pictures are so alike at all angles that their energies cannot be told apart.
  std::vector<std::pair<Ghost, Ghost>> alike;
  int rounds = 0;
  std::vector<std::string> warnings;  // names the surfaces that cannot be told apart
};

// Coatings from the energies of ghosts. The optical centre of the geometry is found anew from the places of ghosts,
// unless its error is below 0.1 pixels. Reflectances that do not settle have a warning.
[[nodiscard]] CONTREJOUR_API Result<LearntCoatings> learn_coatings(const LensPhotographs& photographs,
                                                                   const CoatingFitOptions& options = {},
                                                                   const Context& context = {});

// The ghosts of a lens as discs from which fit_flare can start (FlareFitOptions::starts), the brightest first: those
// with an outline, in a sweep whose light moves up to this angle.
[[nodiscard]] CONTREJOUR_API Result<std::vector<FoundGhost>> discs_of_lens(const LensState& lens,
                                                                           double largest_angle_rad, int most,
                                                                           const Context& context = {});

// How far a lens may be from its prescription before anything is measured: standard errors. 0: not to be learnt.
struct LensTolerances {
  double tilt_rad = 0.00175;  // of each body of glass about its middle, about x and about y: 0.1 degrees
  double decentre_mm = 0.05;  // of each body, in x and in y
  double gap_mm = 0.1;  // of each air space (not of a zoom)
  double focus_mm = 0.3;  // of the sensor's distance from the last vertex
  double stop_radius = 0.03;  // relative
  double stop_position_mm = 0.2;  // along the axis
};

struct AdjustOptions {
  LensTolerances tolerances;
  int max_width = 320;  // as for coatings
  int max_ghosts = 16;  // whose places and sizes are measured: the brightest
  int max_iterations = 8;  // in each of the resolutions, which double up to the width
  double model_error = 0.05;
};

enum class LearntKind { TiltX, TiltY, DecentreX, DecentreY, Gap, Focus, StopRadius, StopPosition };

// A number of the lens as the pictures have it: its change from the file's.
struct LearntNumber {
  LearntKind kind = LearntKind::Focus;
  int first = 0, last = 0;  // surfaces of the body, 1-based; of a gap, those on either side of it
  double value = 0;  // rad, mm; of the stop's radius relative
  double error = 0;  // standard error, with the tolerance as prior
  double tolerance = 0;
  bool determined = false;  // false: the pictures add little to the tolerance
};

struct AdjustedLens {
  Prescription lens;
  std::vector<LearntNumber> numbers;
  Vec2 centre_px;  // where the lens's axis meets the pictures: full-size merged pixels
  std::vector<Ghost> ghosts;  // that were measured
  // RMS distance between ghosts' measured and traced middles, in full-size merged pixels, weighted by what is known of
  // each: of the lens as its file has it, and as it was learnt.
  double rms_before_px = 0, rms_after_px = 0;
  int drawings = 0;  // of all stations
  std::vector<std::string> warnings;
};

// Levenberg-Marquardt: residuals are the displacements of ghosts' middles and the changes of their sizes, in pictures
// against the traced lens; derivatives are differences of traced figures.
[[nodiscard]] CONTREJOUR_API Result<AdjustedLens> adjust_lens(const LensPhotographs& photographs,
                                                              const AdjustOptions& options = {},
                                                              const Context& context = {});

// "tilt about x of surfaces 3-4", "air space behind surface 2", ...
[[nodiscard]] CONTREJOUR_API std::string learnt_name(const LearntNumber& number);

}  // namespace contrejour
