// SPDX-License-Identifier: Apache-2.0
// Makes the names of rays through boxes of a pupil (ghosts/pupils) available in this layer.
#pragma once

#include "ghosts/pupils/lobatto.h"
#include "ghosts/pupils/ray_sheet.h"

namespace contrejour::inline internal::ray_maps {

using namespace pupils;

}  // namespace contrejour::inline internal::ray_maps
