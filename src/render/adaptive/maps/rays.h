// SPDX-License-Identifier: Apache-2.0
// Makes the names of rays through boxes of a pupil (ghosts/pupils) available in this renderer.
#pragma once

#include "ghosts/pupils/lobatto.h"
#include "ghosts/pupils/ray_sheet.h"

namespace contrejour::inline internal::adaptive {

using namespace pupils;

}  // namespace contrejour::inline internal::adaptive
