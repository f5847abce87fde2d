// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/planning/method.h"

namespace contrejour::inline internal {

// bodonyi2023: the cells of all ghosts' ray grids, merged where the map is flat, are put into one buffer; they are
// listed by tile; and each pixel sums the light of its tile's list, in one pass over the frame.
[[nodiscard]] Result<DrawnFlare> render_tiled(const PlannedFrame& planned, const TiledOptions& options,
                                              const Context& context);

inline constexpr Method kTiled = method_of<TiledOptions, render_tiled>({.integrates_pixels = false});

}  // namespace contrejour::inline internal
