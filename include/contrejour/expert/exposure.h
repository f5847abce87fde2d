// SPDX-License-Identifier: Apache-2.0
// The mean of a flare over the time for which the shutter is open, where the lens or the settings change meanwhile: a
// zoom, a rack focus, an iris that closes (docs/physics/motion-blur.md). The flare is drawn at evenly spaced times,
// twice as many again and again, until the mean is known to the error asked for.
// Errors: those of the function that draws; Cancelled. The result is the same for any number of threads.
// Thread-safety: a pure function, but for what the caller's function uses.
#pragma once

#include <functional>

#include "contrejour/context.h"
#include "contrejour/expert/flare_layers.h"
#include "contrejour/export.h"

namespace contrejour {

// Times are fractions of the exposure: 0 is the shutter's opening, 1 its closing.
struct ExposureTimes {
  double parameters = 0.5;                      // lens and settings are those of this time
  double lights_from = 0.5, lights_to = 0.5;  // lights are on this part of their way: a path, or one position
};

// Draws the flare at such times. Layers are matched by their names; a flare without layers has none at any time.
using DrawAtTimes = std::function<Result<LayeredFlare>(const ExposureTimes& times, const Context& context)>;

struct ExposureOptions {
  // The RMS error of the mean relative to its peak, as compare() of metrics.h measures it, beside the error that each
  // drawn flare has by itself.
  double error = 0.003;
  // Lights move, and draw() can draw them on a path. Parameters whose change does not show then cost three drawings.
  bool lights_move = false;
  // The change may turn back in the middle of the exposure, so that its two ends do not tell how much changes.
  bool may_turn_back = false;
  int max_intervals = 128;  // a power of 2; drawing stops there, whatever the error
};

struct ExposedFlare {
  LayeredFlare flare;  // the statistics are sums over everything that was drawn
  int drawn = 0;  // how often the flare was drawn
  double error = 0.0;  // the estimate of the error
};

// Accuracy: the estimate is an upper bound for shapes that move steadily, and errs by the error of the drawn flares.
[[nodiscard]] CONTREJOUR_API Result<ExposedFlare> expose(const DrawAtTimes& draw, const ExposureOptions& options,
                                                         const Context& context = {});

}  // namespace contrejour
