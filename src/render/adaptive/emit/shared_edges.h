// SPDX-License-Identifier: Apache-2.0
// Finds the edges that two polygons of a list have in common, so that tiles draw them once.
#pragma once

#include "render/polygons/polygon_list.h"

namespace contrejour::inline internal::adaptive {

// Sets PolygonList::partner for polygons on a frame of this size: a tile that a shared edge crosses has both polygons.
// Edges whose polygons are far apart in the list may be missed; they are drawn twice.
void share_edges(PolygonList& list, int width, int height);

}  // namespace contrejour::inline internal::adaptive
