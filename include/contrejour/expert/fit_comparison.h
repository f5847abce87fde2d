// SPDX-License-Identifier: Apache-2.0
// The joint fit of all angles against walch2018's coordinate descent (its section 3.3), from the same start and by the
// same cost, with every picture of the model counted that either computes.
// Source: walch2018 3.3, figures 10 and 11. The paper leaves its weights, the filters' widths and the number of
// iterations open; docs/physics/measured-flare.md says what is used.
// Errors: those of fit_flare(). Thread-safety: pure functions; the same bits for any number of threads.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/fit_flare.h"
#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

// walch2018's cost, the mean over all stations: of stations that the descent has not come to, that of the start. Each
// part is relative to the picture's own mean square, or that of its edges, so that no flare at all costs 1 + 1.
struct CostProgress {
  double image_evaluations = 0;
  double cost = 0, mse = 0, edges = 0;
};

struct FitComparison {
  std::vector<CostProgress> ours, walch;  // begin with the start
  std::optional<double> ours_to_walch_cost;  // evaluations until ours is at or below the descent's last cost
};

struct ComparisonSettings {
  std::size_t max_ghosts = 3;  // the first that were found
  int max_stations = 7;  // neighbours, to one side of the axis: the descent takes hundreds of evaluations for each
  int max_width = 120;  // pictures are reduced to at most this width
  int walch_iterations = 30;
  int our_iterations = 40;
};

// start: discs that were found, as fit_flare() returns them; centre_px: the optical centre, as it returns it.
[[nodiscard]] CONTREJOUR_API Result<FitComparison> compare_with_walch(const FlareSweep& sweep,
                                                                      const SweepGeometry& geometry,
                                                                      std::span<const FoundGhost> start, Vec2 centre_px,
                                                                      const ComparisonSettings& settings = {},
                                                                      const Context& context = {});

}  // namespace contrejour
