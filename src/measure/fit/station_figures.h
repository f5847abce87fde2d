// SPDX-License-Identifier: Apache-2.0
// A station's picture against a flare's: what the fit left over.
// Thread-safety: pure functions.
#pragma once

#include <cmath>

#include <vector>

#include "measure/fit/flare_problem.h"

namespace contrejour::inline internal {

// The flare's picture, as it plays back.
[[nodiscard]] Image model_of_station(const MeasuredFlare& flare, const FitStation& station);

// Sums over pixels that stand out of the noise: the residuals' squares, and the picture's.
struct ClearSums {
  double left = 0, all = 0;

  [[nodiscard]] double nrmse() const { return all > 0.0 ? std::sqrt(left / all) : 0.0; }
};
[[nodiscard]] ClearSums clear_sums(const FitStation& station, const Image& model);

// A picture whose pixels that are not fitted, of the light's image and about it, are 0.
[[nodiscard]] Image fitted_part(Image image, const FitStation& station);

// For each pixel and channel, whether it shows the flare's flux: the standard deviation that noise and halo leave it is
// no more than three times the station's usual one. Near the light, where the halo is a hundred times as bright as the
// flare, a sum would be that of the halo's errors. model_error: of a pixel's value, as it is in the weights.
[[nodiscard]] std::vector<bool> shows_flux(const FitStation& station, double model_error);

// The sum over these pixels, the mean of the channels.
[[nodiscard]] double flux_of(const Image& image, const std::vector<bool>& shown);

}  // namespace contrejour::inline internal
