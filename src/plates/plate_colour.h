// SPDX-License-Identifier: Apache-2.0
// Colours of a plate between its own space and the working space.
#pragma once

#include <string>

#include "contrejour/expert/plate.h"
#include "plates/plate_source.h"

namespace contrejour::inline internal {

// Converts the picture's rgb from the space and sets its working space; keeps in `source` what writing back needs.
[[nodiscard]] Result<void> to_working_space(Picture& picture, const PlateColour& colour, PlateSource& source);

// The picture with rgb in the space, as the writer of the format expects it. Pixels that are as they were converted
// from the same space have the values that were read.
[[nodiscard]] Result<Picture> in_space(const Picture& picture, const PlateSource* source, const std::string& space,
                                       const std::string& config, bool is_integer);

}  // namespace contrejour::inline internal
