// SPDX-License-Identifier: Apache-2.0
// A station's picture against a flare's: what the fit left over.
// Thread-safety: pure functions.
#pragma once

#include <cmath>

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

// The sum over the pixels that are fitted, the mean of the channels.
[[nodiscard]] double flux_of(const Image& image, const FitStation& station);

}  // namespace contrejour::inline internal
