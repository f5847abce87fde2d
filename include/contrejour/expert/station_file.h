// SPDX-License-Identifier: Apache-2.0
// The file of a merged station: an EXR with the rate in R, G, B (DN per second), its variance in variance.R, .G, .B and
// in valid.R, .G, .B 1, or 0 where every exposure is saturated. Attributes state the angle and the direct image.
// Errors: those of read_picture() and write_picture(); Parse. Thread-safety: plain values, pure functions.
#pragma once

#include <filesystem>
#include <optional>

#include "contrejour/expert/merge_stations.h"
#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

[[nodiscard]] CONTREJOUR_API Result<void> write_station(const std::filesystem::path& file,
                                                        const MergedStation& station);

// The facts about a station that its finished file states, without the pixels. Errors: those of read_picture(); a file
// that write_station() did not write.
struct StationFacts {
  double angle_deg = 0;
  int width = 0, height = 0;
  std::optional<DirectFlux> direct;
};
[[nodiscard]] CONTREJOUR_API Result<StationFacts> read_station_facts(const std::filesystem::path& file);

// The pixels. Errors: as above; layers of variance or validity that are absent.
[[nodiscard]] CONTREJOUR_API Result<CapturedImage> read_station(const std::filesystem::path& file);

}  // namespace contrejour
