// Makes the names of rays through boxes of a pupil (ghosts/pupils) available in this renderer.
#pragma once

#include "ghosts/pupils/lobatto.h"
#include "ghosts/pupils/ray_sheet.h"

namespace contrejour::adaptive {

using namespace pupils;

}  // namespace contrejour::adaptive
