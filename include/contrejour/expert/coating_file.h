// SPDX-License-Identifier: Apache-2.0
// Measured reflectances as files: a line of headings with the angles of incidence in degrees, then lines of a
// wavelength in nm and the reflectance at each angle, 0 to 1 (docs/formats/coating.md). Values are separated by commas,
// semicolons, tabs or spaces. Bounded in memory and time. Errors: Parse with file and line, Io. Thread-safety: pure
// functions.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "contrejour/expert/coating.h"
#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

[[nodiscard]] CONTREJOUR_API Result<MeasuredCoating> read_measured_coating(std::string_view text,
                                                                           const std::string& file);
[[nodiscard]] CONTREJOUR_API Result<MeasuredCoating> read_measured_coating(const std::filesystem::path& file);

}  // namespace contrejour
