// SPDX-License-Identifier: Apache-2.0
// Combines the statistics of a render's stages.
#pragma once

#include "contrejour/expert/render_statistics.h"

namespace contrejour::inline internal {

// Adds counts and times; of memory held at once, takes the maximum. Phases with the same name are added.
void add(RenderStatistics& sum, const RenderStatistics& one);

// Adds a phase before or after the others, and its time to their total.
void count_first(RenderStatistics& statistics, const char* phase, double ms);
void count_last(RenderStatistics& statistics, const char* phase, double ms);

}  // namespace contrejour::inline internal
