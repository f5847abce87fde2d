// SPDX-License-Identifier: Apache-2.0
// From pictures of a lens turned through a light to a flare that plays back: the ghosts are found, then fitted to all
// angles at once. No ghost is placed by hand and no prescription is needed.
// Source: the model is walch2018 3.2. Differs: the paper's coordinate descent from picture to picture is replaced by
// Levenberg-Marquardt over all pictures with analytic derivatives (docs/physics/measured-flare.md).
// Units: as in measured_flare.h. Errors: InvalidArgument, Cancelled, those of the pictures. Thread-safety: pure
// functions; the same bits for any number of threads.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/capture.h"
#include "contrejour/expert/capture_list.h"
#include "contrejour/expert/measured_flare.h"
#include "contrejour/expert/sweep_geometry.h"
#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

// The stations of a sweep. A picture is asked for once, and kept in reduced size only; pictures may be asked for from
// several threads at once, in any order.
struct FlareSweep {
  std::vector<double> angles_rad;  // of the head, as for the geometry
  std::function<Result<CapturedImage>(std::size_t station)> picture;
  Rgb light{1, 1, 1};  // the sum of the light's direct image over the pixels of such a picture; its levels' unit
  // The light's image in the short exposure of each station, or nothing for a station without a usable one. Its
  // position is measured better than the head's angle, which is off by up to a fiftieth of a degree, predicts it. Its
  // flux stands for `light`, so that the lamp's drift divides out. Empty: no station has any.
  std::vector<std::optional<DirectFlux>> direct = {};
};

// A disc that moves with the light: the start of a fit.
struct FoundGhost {
  double speed = 0;  // of its centre over that of the light's image
  double radius = 0;  // on the axis, as a tangent
  double bend = 0, growth = 0;  // for a light at s: centre = speed * s + bend * s^3, radius * (1 + growth * s^2)
  double first = 0, last = 0;  // tangents of the light's angle between which it is seen
  double contrast = 0;  // over the usual spread
};

struct FlareFitOptions {
  int max_ghosts = 24;  // whose edges are found
  int max_small_ghosts = 12;  // of a few pixels, and bright cores of larger ones
  // The contrast of a ghost's edge must be at least this multiple of the spread of contrasts elsewhere in the pictures.
  // Candidates that reach it are kept only if the fit to the pictures improves by more than chance.
  double min_contrast = 2.0;
  int max_width = 320;  // pictures are reduced by whole numbers to at most this width
  double model_error = 0.1;  // of a pixel's value: what the model is not expected to describe
  double huber = 3.0;  // standard deviations from which residuals count linearly
  // Every n-th station is left out of the fit: it tells how many coefficients the curves of the ghosts need, and how
  // well the flare holds at angles that it was not fitted to. 0: all are fitted, and the curves have the fewest
  // coefficients.
  int held_out_every = 5;
  int max_degree = 2;  // coefficients of a curve beyond the fewest
  // Discs that are tried before any is searched for, the brightest first, as of a known lens (discs_of_lens).
  std::vector<FoundGhost> starts = {};
  int pictures = 0;  // stations, evenly spaced, whose pictures FittedStation keeps
};

// The progress of a fit, for comparison between methods. An image evaluation computes the model of one picture, with
// its derivatives where they are analytic.
struct FitProgress {
  double image_evaluations = 0;
  double cost = 0;
};

// A station after the fit. Fluxes are relative to the light's, and of the pixels that no halo or saturation covers.
struct FittedStation {
  std::size_t station = 0;  // of the sweep
  double s = 0;  // tangent of the light's angle; below 0 to the left
  bool held_out = false;
  double captured = 0, fitted = 0;  // flux, the mean of the channels
  double nrmse = 0;  // RMS of the residuals over that of the picture without halo, where it stands out of the noise
  // Without halo, relative to the light; 0 where halo or saturation covers the flare. Without pixels if not asked for.
  Image captured_picture, fitted_picture;
};

struct FittedFlare {
  MeasuredFlare flare;
  // Optical centre of the pictures: the ghosts determine it better than the light's images do.
  Vec2 centre_px;
  // The start of each ghost of the flare but its first, which is the light of ghosts larger than the picture ("veil"),
  // and its last ones without an edge, which stand for ghosts that are not found ("diffuse, ..."). Small ghosts come
  // after those with an edge, and last those that were found only in what the others leave.
  std::vector<FoundGhost> found;
  std::vector<FitProgress> progress;  // of the last fit
  double image_evaluations = 0;  // in all
  double nrmse = 0, held_out_nrmse = 0;  // as of a station, over those that were fitted and those that were held out
  int degree = 0;  // coefficients beyond the fewest, as the stations held out chose
  std::vector<FittedStation> stations;  // in the order of the sweep
  std::vector<std::string> warnings;
};

// A flare without ghosts, with a warning, if none is found. Errors: fewer than five stations, pictures that differ in
// size, angles whose number is not the pictures'.
[[nodiscard]] CONTREJOUR_API Result<FittedFlare> fit_flare(const FlareSweep& sweep, const SweepGeometry& geometry,
                                                           const FlareFitOptions& options = {},
                                                           const Context& context = {});

}  // namespace contrejour
