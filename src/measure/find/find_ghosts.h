// SPDX-License-Identifier: Apache-2.0
// Discs that move with the light: where the pictures of a sweep show one more ghost.
// For each speed and radius the step across the circle is measured all around it in every station. Its low quantile
// over the circle is the station's step, and the evidence of all stations' steps the contrast, so that a border of
// another ghost that lies along a part of the circle, or in one station, does not count.
// Thread-safety: pure functions; the same bits for any number of threads.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/fit_flare.h"
#include "measure/fit/flare_problem.h"

namespace contrejour::inline internal {

// One picture to search, in standard deviations: proportional to brightness where the floor decides, to its logarithm
// where a part of the brightness does, so that steps of dim ghosts count as those of bright ones; NaN where a channel
// was not measured.
struct SearchPicture {
  double s = 0;
  StationFrame frame;
  Image value;  // one channel
  Image partial = {};  // the mean of the channels that were measured; NaN where none was
};
// usual_error: the usual standard deviation. counted_part: of its square, which is mostly what the model does not
// describe of bright ghosts: with less, wide dim ghosts stand out more, and what bright ones leave, too.
[[nodiscard]] std::vector<SearchPicture> search_pictures(std::span<const FitStation> stations, double usual_error,
                                                         double counted_part = 1.0);

struct GhostSearch {
  double max_speed = 6.0;
  double min_contrast = 2.0;  // as in FlareFitOptions
};

// The disc of the highest contrast that is not among those excluded, or none.
[[nodiscard]] std::optional<FoundGhost> strongest_disc(std::span<const SearchPicture> pictures,
                                                       const GhostSearch& search, std::span<const FoundGhost> excluded,
                                                       const Context& context);

}  // namespace contrejour::inline internal
