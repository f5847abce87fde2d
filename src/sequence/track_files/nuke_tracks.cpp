// SPDX-License-Identifier: Apache-2.0
// Nuke's ASCII files of a Tracker: frame, x and y of one track or more in a line; and those of a CameraTracker, in
// Shake's form, with a heading for each track.
#include <fmt/format.h>

#include "base/near_name.h"
#include "base/trimmed.h"
#include "sequence/track_files/track_lines.h"
#include "sequence/track_files/track_readers.h"

namespace contrejour::inline internal {
namespace {

constexpr std::string_view kComments = "#;/";
constexpr std::string_view kFieldSeparators = " \t,:";
constexpr std::string_view kHeading = "TrackName";

// The origin is the bottom left corner.
Vec2 position_px(double x, double y, const TrackFileSettings& settings) { return {x, settings.height - y}; }

struct Row {
  int frame = 0;
  std::vector<double> numbers;
};

Result<Row> row_of(const TrackLine& line, const std::string& file) {
  const auto fields = fields_between(line.text, kFieldSeparators);
  const auto frame = fields.empty() ? std::nullopt : track_frame(fields[0]);
  if (!frame) return wrong_line(file, line.number, "the line does not begin with the number of a frame");
  Row row{*frame, {}};
  for (std::size_t k = 1; k < fields.size(); ++k) {
    const auto number = track_number(fields[k]);
    if (!number)
      return wrong_line(file, line.number,
                        fmt::format("frame {}: \"{}\" is not a number", *frame, shortened(fields[k])));
    row.numbers.push_back(*number);
  }
  return row;
}

PointTracks read_headed(const std::vector<TrackLine>& lines, const std::string& file,
                        const TrackFileSettings& settings) {
  TrackCollector tracks(file, settings, true);
  std::size_t track = 0;
  for (const TrackLine& line : lines) {
    if (line.text.starts_with(kHeading)) {
      const auto begun = tracks.begin(trimmed(line.text.substr(kHeading.size())), line.number);
      if (!begun) return tl::unexpected(begun.error());
      track = *begun;
      continue;
    }
    if (line.text.starts_with("Frame")) continue;  // the columns' titles
    const auto row = row_of(line, file);
    if (!row) return tl::unexpected(row.error());
    if (row->numbers.size() < 2)
      return wrong_line(file, line.number, fmt::format("frame {} has no x and y", row->frame));
    if (auto ok = tracks.add(track, row->frame, position_px(row->numbers[0], row->numbers[1], settings), line.number);
        !ok)
      return tl::unexpected(ok.error());
  }
  return tracks.finish();
}

PointTracks read_columns(const std::vector<TrackLine>& lines, const std::string& file,
                         const TrackFileSettings& settings) {
  TrackCollector tracks(file, settings, false);
  std::size_t columns = 0;
  for (const TrackLine& line : lines) {
    const auto row = row_of(line, file);
    if (!row) return tl::unexpected(row.error());
    const std::size_t count = row->numbers.size();
    if (columns == 0) {
      for (std::size_t k = 0; k + 1 < count; k += 2)
        if (const auto begun = tracks.begin("", line.number); !begun) return tl::unexpected(begun.error());
      columns = count;
    }
    if (count != columns || count % 2 != 0 || count == 0)
      return wrong_line(
          file, line.number,
          fmt::format("frame {}: a line is a frame, and x and y for each track; this one has {} numbers after the "
                      "frame{}",
                      row->frame, count, columns == count ? "" : fmt::format(", the first one {}", columns)));
    for (std::size_t k = 0; k < count; k += 2)
      if (auto ok =
              tracks.add(k / 2, row->frame, position_px(row->numbers[k], row->numbers[k + 1], settings), line.number);
          !ok)
        return tl::unexpected(ok.error());
  }
  return tracks.finish();
}

}  // namespace

PointTracks read_nuke_tracks(std::string_view text, const std::string& file, const TrackFileSettings& settings) {
  const auto lines = track_lines(text, kComments);
  const bool is_headed = !lines.empty() && lines.front().text.starts_with(kHeading);
  return is_headed ? read_headed(lines, file, settings) : read_columns(lines, file, settings);
}

}  // namespace contrejour::inline internal
