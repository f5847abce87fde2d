// SPDX-License-Identifier: Apache-2.0
// SynthEyes' "Tracker 2-D Paths": name, frame, u, v and a sum of flags in each line.
#include <fmt/format.h>

#include "base/trimmed.h"
#include "sequence/track_files/track_lines.h"
#include "sequence/track_files/track_readers.h"

namespace contrejour::inline internal {
namespace {

constexpr int kHasPosition = 4;  // the flag without which u and v say nothing

struct SynthEyesLine {
  std::string_view name;
  int frame = 0;
  double u = 0, v = 0;
  int flags = 0;
};

// The name may have spaces in it.
std::optional<SynthEyesLine> parse_line(std::string_view text) {
  const auto fields = fields_between(text, " \t");
  if (fields.size() < 5) return std::nullopt;
  const std::size_t first = fields.size() - 4;
  const auto frame = track_frame(fields[first]);
  const auto u = track_number(fields[first + 1]), v = track_number(fields[first + 2]);
  const auto flags = track_frame(fields[first + 3]);
  if (!frame || !u || !v || !flags || *flags < 0) return std::nullopt;
  const auto name_size = static_cast<std::size_t>(fields[first].data() - text.data());
  return SynthEyesLine{trimmed(text.substr(0, name_size)), *frame, *u, *v, *flags};
}

}  // namespace

// u and v are -1 at the left and top edges, 1 at the right and bottom ones.
PointTracks read_syntheyes_tracks(std::string_view text, const std::string& file, const TrackFileSettings& settings) {
  TrackCollector tracks(file, settings, true);
  for (const TrackLine& line : track_lines(text, "#")) {
    const auto parsed = parse_line(line.text);
    if (!parsed) return wrong_line(file, line.number, "the line is not a name, a frame, u, v and flags");
    if ((parsed->flags & kHasPosition) == 0) continue;
    const auto track = tracks.named(parsed->name, line.number);
    if (!track) return tl::unexpected(track.error());
    const Vec2 position{0.5 * (1.0 + parsed->u) * settings.width, 0.5 * (1.0 + parsed->v) * settings.height};
    if (auto ok = tracks.add(*track, parsed->frame, position, line.number); !ok) return tl::unexpected(ok.error());
  }
  return tracks.finish();
}

}  // namespace contrejour::inline internal
