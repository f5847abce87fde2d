// SPDX-License-Identifier: Apache-2.0
// Our CSV of tracks: name, frame, x and y in pixels from the top left corner.
#include "sequence/track_files/csv_table.h"
#include "sequence/track_files/track_lines.h"
#include "sequence/track_files/track_readers.h"

namespace contrejour::inline internal {

PointTracks read_csv_tracks(std::string_view text, const std::string& file, const TrackFileSettings& settings) {
  const auto table = read_csv_table(text, file, {"x", "y"});
  if (!table) return tl::unexpected(table.error());
  if (!table->has_frames) return wrong_line(file, 1, "the first line has no column frame; give name,frame,x,y");
  TrackCollector tracks(file, settings, true);
  for (const CsvRow& row : table->rows) {
    const auto track = tracks.named(row.name, row.line);
    if (!track) return tl::unexpected(track.error());
    const Vec2 position{row.numbers[0], row.numbers[1]};
    if (auto ok = tracks.add(*track, static_cast<int>(row.numbers[2]), position, row.line); !ok)
      return tl::unexpected(ok.error());
  }
  return tracks.finish();
}

}  // namespace contrejour::inline internal
