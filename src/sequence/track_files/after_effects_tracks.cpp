// SPDX-License-Identifier: Apache-2.0
// After Effects' keyframes as text, as it copies them: a heading, then blocks of a property each, whose lines begin
// with a tab and have a tab between their fields. Properties in "X pixels" and "Y pixels" are tracks.
#include <algorithm>

#include <fmt/format.h>

#include "base/near_name.h"
#include "base/trimmed.h"
#include "sequence/track_files/track_lines.h"
#include "sequence/track_files/track_readers.h"

namespace contrejour::inline internal {
namespace {

// The property's own name is the last field of its line.
std::string_view property_of(std::string_view heading) {
  const std::size_t tab = heading.rfind('\t');
  return tab == std::string_view::npos ? heading : heading.substr(tab + 1);
}

std::string track_name(std::string_view heading) {
  std::string name;
  for (const std::string_view field : all_fields(heading, '\t')) {
    if (field.empty() || field == "Transform" || field == "Effects" || field == "Motion Trackers") continue;
    if (!name.empty()) name += ' ';
    name += field;
  }
  return name;
}

class AfterEffectsReader {
 public:
  AfterEffectsReader(std::vector<TrackLine> lines, const std::string& file, const TrackFileSettings& settings)
      : lines_(std::move(lines)), file_(file), tracks_(file, settings, false) {
    has_attach_points_ = std::ranges::any_of(
        lines_, [](const TrackLine& line) { return property_of(trimmed(line.text)).starts_with("Attach Point"); });
  }

  [[nodiscard]] PointTracks read() {
    for (const TrackLine& line : lines_)
      if (auto ok = read_line(line); !ok) return tl::unexpected(ok.error());
    return tracks_.finish();
  }

 private:
  [[nodiscard]] Result<void> read_line(const TrackLine& line) {
    if (!line.text.starts_with('\t')) {
      heading_ = trimmed(line.text);
      is_position_ = false;
      return {};
    }
    const auto fields = all_fields(line.text.substr(1), '\t');
    if (fields[0] == "Frame") return begin_block(fields, line.number);
    return is_position_ ? read_key(fields, line.number) : Result<void>();
  }

  // A point of a motion tracker has a centre and an attached point, which is the one that is used.
  [[nodiscard]] Result<void> begin_block(const std::vector<std::string_view>& titles, int line) {
    const std::string_view property = property_of(heading_);
    is_position_ = titles.size() >= 3 && titles[1] == "X pixels" && titles[2] == "Y pixels" &&
                   !property.starts_with("Anchor Point") &&
                   !(has_attach_points_ && property.starts_with("Feature Center"));
    if (!is_position_) return {};
    const auto track = tracks_.begin(track_name(heading_), line);
    if (!track) return tl::unexpected(track.error());
    track_ = *track;
    return {};
  }

  // A property without keyframes has one line, without a frame.
  [[nodiscard]] Result<void> read_key(const std::vector<std::string_view>& fields, int line) {
    if (fields.size() < 3)
      return wrong_line(file_, line,
                        fmt::format("\"{}\": the line is not a frame, x and y", shortened(track_name(heading_))));
    const auto frame = fields[0].empty() ? std::optional<int>(0) : track_frame(fields[0]);
    const auto x = track_number(fields[1]), y = track_number(fields[2]);
    if (!frame)
      return wrong_line(file_, line,
                        fmt::format("\"{}\" is not the number of a frame; keyframes between frames cannot be read",
                                    shortened(fields[0])));
    if (!x || !y) return wrong_line(file_, line, fmt::format("frame {}: x and y are not numbers", *frame));
    return tracks_.add(track_, *frame, {*x, *y}, line);
  }

  std::vector<TrackLine> lines_;
  const std::string& file_;
  TrackCollector tracks_;
  std::string_view heading_;
  std::size_t track_ = 0;
  bool is_position_ = false, has_attach_points_ = false;
};

}  // namespace

PointTracks read_after_effects_tracks(std::string_view text, const std::string& file,
                                      const TrackFileSettings& settings) {
  return AfterEffectsReader(track_lines(text, "", true), file, settings).read();
}

}  // namespace contrejour::inline internal
