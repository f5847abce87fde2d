// Edges that two polygons of a list have in common, found so that tiles need draw them once.
#pragma once

#include "render/adaptive/tiles/polygon_list.h"
#include "render/adaptive/tiles/tiles.h"

namespace contrejour::adaptive {

// Sets PolygonList::partner, of polygons on the frame: a tile that such an edge crosses has both. Of edges found too
// far apart in the list some are missed: those are drawn twice.
void share_edges(PolygonList& list, const TileGrid& grid);

}  // namespace contrejour::adaptive
