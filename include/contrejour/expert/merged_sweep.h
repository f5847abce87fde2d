// SPDX-License-Identifier: Apache-2.0
// The folder that `measure merge` wrote, as the sweep that a fit reads (station_file.h).
// Errors: Io, Parse, InvalidArgument. Thread-safety: plain values, pure functions.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "contrejour/expert/fit_flare.h"
#include "contrejour/expert/sweep_geometry.h"
#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

struct MergedSweep {
  std::vector<std::filesystem::path> files;  // of the stations, by their numbers
  std::vector<double> angles_rad;
  std::vector<std::optional<DirectFlux>> direct;
  ExpectedCentre expected;  // of the pictures
  std::vector<std::string> warnings;  // files that are left out because they cannot be read

  // Reads a station's pixels when the fit asks for them.
  [[nodiscard]] CONTREJOUR_API FlareSweep sweep() const;
};

// Errors: no such folder; fewer than five stations in it that can be read.
[[nodiscard]] CONTREJOUR_API Result<MergedSweep> open_merged(const std::string& folder);

// The geometry from the places of the light's image. Errors: fewer than five of the stations state one.
[[nodiscard]] CONTREJOUR_API Result<SweepGeometry> geometry_of(const MergedSweep& merged, const std::string& folder);

}  // namespace contrejour
