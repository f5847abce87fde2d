// Edges that two polygons of a list have in common, found so that tiles need draw them once.
#pragma once

#include "render/adaptive/polygon_list.h"
#include "render/adaptive/tiles.h"

namespace contrejour::adaptive {

// Sets PolygonList::partner. Only neighbours that touch the same columns of tiles share edges, so that a tile with one
// of them has the other. Of edges found too far apart in the list some are missed: those are drawn twice.
void share_edges(PolygonList& list, const TileGrid& grid);

}  // namespace contrejour::adaptive
