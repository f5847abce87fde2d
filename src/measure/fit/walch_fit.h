// SPDX-License-Identifier: Apache-2.0
// The fit of walch2018 3.3 as a baseline to compare with: grey pictures, one station after another, coordinate descent.
// The paper leaves its weights, widths and numbers of iterations open: those here are ours.
// Thread-safety: pure functions.
#pragma once

#include <span>
#include <vector>

#include "contrejour/expert/fit_flare.h"
#include "measure/fit/flare_problem.h"

namespace contrejour::inline internal {

struct WalchSettings {
  double mse_weight = 1.0, edge_weight = 1.0;
  double smoothing_px = 1.5;  // of the Gauss filters before and after the Laplacian
  int iterations = 40;  // of each station
  double first_step = 0.05;  // of each parameter, relative
  int iterations_per_rate = 100;
  double rate_decay = 0.8;  // of all steps, after so many iterations
};

// The parts of the cost, each relative to the picture's own.
struct WalchCost {
  double mse = 0, edges = 0;
};

// A station after an iteration.
struct WalchStep {
  std::size_t station = 0;
  double image_evaluations = 0;  // in all
  WalchCost cost;
};

// The ghosts of each station, with their own parameters there.
struct WalchFit {
  std::vector<std::vector<GhostAtAngle>> ghosts;
  std::vector<FitProgress> progress;  // after each iteration: the mean cost of the stations fitted so far
  std::vector<WalchStep> steps;  // after each iteration
  double image_evaluations = 0;
};

// A flare's ghosts for a light at s, whose first channel is the sum of three.
[[nodiscard]] std::vector<GhostAtAngle> grey_ghosts(const MeasuredFlare& flare, double s);

// One channel: the sum of three.
[[nodiscard]] Image grey_picture(const FitStation& station);
[[nodiscard]] Image grey_model(std::span<const GhostAtAngle> ghosts, const FitStation& station);

// walch2018 eq. 1 and 3.3.1: the mean square difference and that of the smoothed edges, both over the picture's mean
// square (of the edges' likewise).
[[nodiscard]] WalchCost walch_costs(const Image& picture, const Image& model, double smoothing_px);

// The picture's own mean squares, which the parts are relative to.
[[nodiscard]] WalchCost walch_scale(const Image& picture, double smoothing_px);
[[nodiscard]] double walch_cost(const Image& picture, const Image& model, const WalchSettings& settings);

// From the flare's ghosts at a key station, the one in the middle of the range, to its neighbours and on; once four
// stations are fitted, a parabola through each parameter predicts the next start.
[[nodiscard]] WalchFit walch_fit(std::span<const FitStation> stations, const MeasuredFlare& start,
                                 const WalchSettings& settings, const Context& context);

}  // namespace contrejour::inline internal
