// SPDX-License-Identifier: Apache-2.0
// Weighted sums of flares and of their layers. Thread-safety: plain values.
#pragma once

#include "contrejour/expert/flare_layers.h"

namespace contrejour::inline internal {

// Adds weight * from; layers are matched by their names, and their rectangles grow to hold both.
void add_weighted(LayeredFlare& to, const LayeredFlare& from, double weight);

// All pixels times a factor.
void scale(LayeredFlare& flare, double factor);

// Adds the times and counts of another drawing of the same frame.
void add_statistics(RenderStatistics& to, const RenderStatistics& from);

}  // namespace contrejour::inline internal
