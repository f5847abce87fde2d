// SPDX-License-Identifier: Apache-2.0
// The state of a fit, and what its steps share: the pictures at several resolutions, and least squares over them.
// Thread-safety: values; functions change the state that they are given.
#pragma once

#include <vector>

#include "contrejour/expert/fit_flare.h"
#include "measure/fit/flare_problem.h"
#include "measure/fit/stations.h"

namespace contrejour::inline internal {

inline constexpr double kLeastGain = 8.0;  // of the cost for each unknown of a new ghost: neighbouring pixels err alike
inline constexpr int kMostRejected = 4;  // candidates in a row, after which a search ends
inline constexpr int kAloneIterations = 25, kTogetherIterations = 8;
inline constexpr double kNoHuber = 1e9, kFarHuber = 10.0;  // far from the solution every residual is an outlier

struct FlareFit {
  FlareFitOptions options;
  Context context;
  SweepStations sweep, held_out;
  std::vector<std::size_t> fitted_of, held_of;  // stations of the sweep
  // Without the halo, in the full reduced size.
  std::vector<FitStation> fine, held_fine;
  // Without small ghosts either, which are fitted to windows about them: in half the size, to be searched, and samples
  // of both sizes, to be fitted.
  std::vector<FitStation> coarse, held_coarse, coarse_samples, fine_samples;
  std::vector<MeasuredGhost> small;
  std::vector<FoundGhost> small_found;
  FittedFlare result;  // without small ghosts until the end
  double centre_shift = 0;  // as a tangent

  [[nodiscard]] MeasuredFlare& flare() { return result.flare; }
  [[nodiscard]] const MeasuredFlare& flare() const { return result.flare; }
  // One pixel of how many is fitted, where it is one of `every` in pictures of 320 pixels: as many pixels of larger
  // pictures, since what the model does not describe, and not noise, limits the fit.
  [[nodiscard]] int sampling(int every) const;
  // The same for all stations together: a longer sweep has as many pixels in all.
  [[nodiscard]] int sampling_of_all(int every) const;
  // The flare with these ghosts instead of its own.
  [[nodiscard]] MeasuredFlare flare_of(std::vector<MeasuredGhost> ghosts) const;
};

[[nodiscard]] std::vector<FitStation> half_size_stations(const std::vector<FitStation>& stations);

// The standard deviation of a usual pixel.
[[nodiscard]] double usual_error(const std::vector<FitStation>& stations);

// Stations from which a flare has been subtracted.
[[nodiscard]] std::vector<FitStation> residual_stations(std::vector<FitStation> stations, const MeasuredFlare& flare,
                                                        const Context& context);

// The halo of what the flare leaves, which is then subtracted from the pictures. quantile: as of HaloSettings.
void separate_halo(FlareFit& fit, double quantile);

// Subtracts the small ghosts anew from the pictures that are without them.
void subtract_small_ghosts(FlareFit& fit);

// Moves the optical centre in all stations.
void move_all(FlareFit& fit, double centre_shift);

// Leaves out ghosts with values beyond the limits of a flare, which could neither be drawn nor read again, and says so.
void drop_unbounded(FlareFit& fit);

struct LevelSettings {
  double huber = 3.0;
  int iterations = 25;
  bool with_centre = false;
  bool small = false;  // small ghosts may fade over their whole radius
  bool near_start = false;  // ghosts stay within a part of their radius of the start
};
struct LevelFit {
  MeasuredFlare flare;
  double cost = 0;
  double centre_shift = 0;
};
[[nodiscard]] LevelFit optimised(FlareFit& fit, const std::vector<FitStation>& stations, const MeasuredFlare& flare,
                                 const LevelSettings& settings);

}  // namespace contrejour::inline internal
