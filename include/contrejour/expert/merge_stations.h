// SPDX-License-Identifier: Apache-2.0
// Merges the stations of a sweep, some at a time, so that memory is bounded: a station takes about 60 bytes a raw pixel
// while it is merged. Errors: Cancelled. Thread-safety: the callbacks are called from several threads.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/capture_list.h"
#include "contrejour/export.h"
#include "contrejour/result.h"

namespace contrejour {

struct MergedStation {
  int station = 0;
  double angle_deg = 0;
  CapturedImage image;
  std::optional<DirectFlux> direct;  // none: there is no short exposure, or the light is not in it
};

using ReadRawFrame = std::function<Result<RawFrame>(const PlannedCapture& capture)>;
using WriteStation = std::function<Result<void>(const MergedStation& station)>;

// The outcome of a station, in the order of the stations.
struct StationOutcome {
  std::optional<Error> error;  // the station was not written: a file is missing or broken
  std::vector<std::string> warnings;
};

// Reads, merges and writes each station; one that fails does not stop the others.
[[nodiscard]] CONTREJOUR_API Result<std::vector<StationOutcome>> merge_stations(
    std::span<const StationFiles> stations, const ReadRawFrame& read, const WriteStation& write,
    const MergeSettings& settings, int at_once, const Context& context = {});

}  // namespace contrejour
