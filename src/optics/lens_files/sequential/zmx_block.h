// SPDX-License-Identifier: Apache-2.0
// The rows of a SURF block of a Zemax file.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "optics/lens_files/sequential/zmx_row.h"
#include "optics/lens_files/sequential/zmx_surface.h"

namespace contrejour::inline internal {

// False for a keyword that is not a surface's.
[[nodiscard]] bool read_zmx_surface_row(const ZmxRow& row, ZmxSurface& surface, std::vector<std::string>& warnings);

// True for a keyword of a surface that changes no ray: plots, evaluated solves, tolerances, physical optics.
[[nodiscard]] bool zmx_is_passed_over(std::string_view keyword);

}  // namespace contrejour::inline internal
