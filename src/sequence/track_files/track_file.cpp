// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/decode_text.h"
#include "base/lower_extension.h"
#include "base/text_file.h"
#include "sequence/track_files/track_lines.h"
#include "sequence/track_files/track_readers.h"

namespace contrejour {
namespace {

constexpr std::size_t kMaxTrackFileBytes = std::size_t{64} << 20U;  // as a file of lights

bool are_numbers(const std::vector<std::string_view>& fields) {
  return std::ranges::all_of(fields, [](std::string_view field) { return track_number(field).has_value(); });
}

// The format of a line of a table: SynthEyes begins with a name and ends with a whole number.
std::optional<TrackFormat> format_of_line(std::string_view line) {
  const auto fields = fields_between(line, " \t,:");
  if (fields.size() == 1 && track_frame(fields[0])) return TrackFormat::Equalizer;
  if (fields.size() >= 3 && are_numbers(fields)) return TrackFormat::NukeTracker;
  if (fields.size() >= 5 && track_frame(fields.back())) return TrackFormat::SynthEyes;
  return std::nullopt;
}

}  // namespace

Result<TrackFormat> track_format(std::string_view text, const std::string& file) {
  if (lower_extension(file) == ".chan") return TrackFormat::Chan;
  const auto lines = track_lines(text.substr(0, 65536), "#;/");
  if (!lines.empty()) {
    const std::string_view first = lines.front().text;
    if (first.starts_with("Adobe After Effects")) return TrackFormat::AfterEffects;
    if (first.starts_with("TrackName")) return TrackFormat::NukeTracker;
    const auto titles = all_fields(first, ',');
    if (std::ranges::find(titles, "name") != titles.end()) return TrackFormat::Csv;
    if (const auto format = format_of_line(first)) return *format;
  }
  return failure(ErrorCode::Parse,
                 fmt::format("the file is like none of the formats of tracks; --format names one: {}",
                             fmt::join(kTrackFormatNames, ", ")),
                 {file, lines.empty() ? 0 : lines.front().number, 0});
}

Result<std::vector<PointTrack>> read_tracks(std::string_view text, const std::string& file, TrackFormat format,
                                            const TrackFileSettings& settings) {
  if (settings.width < 1 || settings.height < 1) return invalid_argument("tracks need the size of their picture");
  if (auto ok = check_frame_offset(settings.frame_offset); !ok) return tl::unexpected(ok.error());
  switch (format) {
    case TrackFormat::NukeTracker: return read_nuke_tracks(text, file, settings);
    case TrackFormat::Equalizer: return read_equalizer_tracks(text, file, settings);
    case TrackFormat::SynthEyes: return read_syntheyes_tracks(text, file, settings);
    case TrackFormat::AfterEffects: return read_after_effects_tracks(text, file, settings);
    case TrackFormat::Csv: return read_csv_tracks(text, file, settings);
    case TrackFormat::Chan: break;
  }
  return invalid_argument("a .chan file has a camera, not tracks; give the points that it sees, too");
}

Result<std::string> read_track_text(const std::filesystem::path& file) {
  auto bytes = read_text_file(file, kMaxTrackFileBytes, "name a file of tracks (docs/formats/tracks.md)");
  if (!bytes) return bytes;
  return decode_text(*bytes);
}

}  // namespace contrejour
