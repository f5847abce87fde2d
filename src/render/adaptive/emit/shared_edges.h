// SPDX-License-Identifier: Apache-2.0
// Finds the edges that two polygons of a list have in common, so that tiles draw them once.
#pragma once

#include "render/adaptive/tiles/polygon_list.h"
#include "render/adaptive/tiles/tiles.h"

namespace contrejour::inline internal::adaptive {

// Sets PolygonList::partner for polygons on the frame: a tile that a shared edge crosses has both polygons. Edges whose
// polygons are far apart in the list may be missed; they are drawn twice.
void share_edges(PolygonList& list, const TileGrid& grid);

}  // namespace contrejour::inline internal::adaptive
