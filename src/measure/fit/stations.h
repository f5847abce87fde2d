// SPDX-License-Identifier: Apache-2.0
// The pictures of a sweep, reduced for a fit: in units of the light, with weights, without the halo.
// Thread-safety: pure functions.
#pragma once

#include <vector>

#include "contrejour/expert/fit_flare.h"
#include "measure/fit/flare_problem.h"
#include "measure/fit/halo.h"

namespace contrejour::inline internal {

struct SweepStations {
  std::vector<FitStation> stations;  // with the halo in them
  std::vector<Vec2> lights_px;       // where the light's image lies
  double masked_px = 0;              // about it
  double saturated = 0;              // the part of all pixels that no exposure shows
};

[[nodiscard]] Result<SweepStations> reduced_stations(const FlareSweep& sweep, const SweepGeometry& geometry,
                                                     const FlareFitOptions& options, const Context& context);

// Means over blocks of 2 x 2 pixels.
[[nodiscard]] FitStation half_size_station(const FitStation& station);

// Stations without the halo, weighted by noise, halo, and what the model is not expected to describe. deviations: by
// which each station's halo is multiplied; empty: 1.
[[nodiscard]] std::vector<FitStation> stations_without(const SweepStations& sweep, const HaloProfile& halo,
                                                       double model_error, const std::vector<double>& deviations = {});

// Gives channels that are not measured, as they saturate, the mean of the others at their pixels, or their least value
// if that is larger, with twice that as the error. Otherwise nothing bounds the level of a small ghost in a channel
// that its middle saturates.
void guess_channels(FitStation& station);

// Stations of which one pixel of `every` is fitted, but every pixel about the small ghosts of a flare; with guesses of
// the channels that are not measured.
[[nodiscard]] std::vector<FitStation> sampled_stations(std::vector<FitStation> stations, int every,
                                                       const MeasuredFlare& flare = {});

}  // namespace contrejour::inline internal
