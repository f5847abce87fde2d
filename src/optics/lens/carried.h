#pragma once

#include "contrejour/lens.h"

namespace contrejour {

// How a surface stands that is part of a body which is turned about a point on the lens's axis and moved; its vertex
// would be that far behind the point, its own pose that in the body. (A toroid's own turn is left as it is: the
// smallest turns of two axes make up that of the third but for a twist of second order.)
[[nodiscard]] SurfacePose carried(const SurfacePose& body, double behind_mm, const SurfacePose& own);

}  // namespace contrejour
