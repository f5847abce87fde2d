// SPDX-License-Identifier: Apache-2.0
// Makes the names of rays through boxes of a pupil (ghosts/pupils) and of polynomials through them (render/ray_maps)
// available in this renderer.
#pragma once

#include "ghosts/pupils/lobatto.h"
#include "ghosts/pupils/ray_sheet.h"
#include "render/ray_maps/patch.h"

namespace contrejour::inline internal::adaptive {

using namespace pupils;
using namespace ray_maps;

}  // namespace contrejour::inline internal::adaptive
