// SPDX-License-Identifier: Apache-2.0
// One reader a format (docs/formats/tracks.md); read_tracks chooses among them. The settings have a size.
// Thread-safety: pure functions.
#pragma once

#include "contrejour/expert/track_files.h"

namespace contrejour::inline internal {

using PointTracks = Result<std::vector<PointTrack>>;

[[nodiscard]] PointTracks read_nuke_tracks(std::string_view text, const std::string& file,
                                           const TrackFileSettings& settings);
[[nodiscard]] PointTracks read_equalizer_tracks(std::string_view text, const std::string& file,
                                                const TrackFileSettings& settings);
[[nodiscard]] PointTracks read_syntheyes_tracks(std::string_view text, const std::string& file,
                                                const TrackFileSettings& settings);
[[nodiscard]] PointTracks read_after_effects_tracks(std::string_view text, const std::string& file,
                                                    const TrackFileSettings& settings);
[[nodiscard]] PointTracks read_csv_tracks(std::string_view text, const std::string& file,
                                          const TrackFileSettings& settings);

}  // namespace contrejour::inline internal
