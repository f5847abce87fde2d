// SPDX-License-Identifier: Apache-2.0
// Makes the names of pupils (render/pupils), of rays through their boxes and of polynomials through these
// (render/ray_maps) available in this renderer.
#pragma once

#include "render/ray_maps/lobatto.h"
#include "render/ray_maps/lobatto_rays.h"
#include "render/ray_maps/patch.h"

namespace contrejour::inline internal::adaptive {

using namespace pupils;
using namespace ray_maps;

}  // namespace contrejour::inline internal::adaptive
