// What a render's stages took, put together.
#pragma once

#include "contrejour/render_statistics.h"

namespace contrejour {

// Sums; of what was held at once, the most. Phases of one name become one.
void add(RenderStatistics& sum, const RenderStatistics& one);

// A phase before or after the others, and in their total.
void count_first(RenderStatistics& statistics, const char* phase, double ms);
void count_last(RenderStatistics& statistics, const char* phase, double ms);

}  // namespace contrejour
