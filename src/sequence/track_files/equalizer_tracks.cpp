// SPDX-License-Identifier: Apache-2.0
// 3DEqualizer's 2D tracks: the number of points; for each its name, the number of its colour, the number of its frames,
// and these: frame, x, y.
#include <fmt/format.h>

#include "base/near_name.h"
#include "sequence/track_files/track_lines.h"
#include "sequence/track_files/track_readers.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kLinesBeforeFrames = 3;

// Reads the points one after the other.
class EqualizerReader {
 public:
  EqualizerReader(std::vector<TrackLine> lines, const std::string& file, const TrackFileSettings& settings)
      : lines_(std::move(lines)), file_(file), settings_(settings), tracks_(file, settings, true) {}

  [[nodiscard]] PointTracks read() {
    const auto count = whole_number("the first line is not the number of points");
    if (!count) return tl::unexpected(count.error());
    for (int k = 0; k < *count; ++k)
      if (auto ok = read_point(k + 1, *count); !ok) return tl::unexpected(ok.error());
    if (next_ < lines_.size())
      return wrong_line(file_, lines_[next_].number,
                        fmt::format("there are more lines than those of {} points", *count));
    return tracks_.finish();
  }

 private:
  [[nodiscard]] int line_number() const {
    return lines_.empty() ? 1 : lines_[std::min(next_, lines_.size() - 1)].number;
  }

  [[nodiscard]] Result<int> whole_number(std::string_view otherwise) {
    const auto number = next_ < lines_.size() ? track_frame(lines_[next_].text) : std::nullopt;
    if (!number || *number < 0) return wrong_line(file_, line_number(), std::string(otherwise));
    ++next_;
    return *number;
  }

  [[nodiscard]] Result<void> read_point(int number, int count) {
    if (next_ + kLinesBeforeFrames > lines_.size())
      return wrong_line(file_, line_number(), fmt::format("the file ends before point {} of {}", number, count));
    const std::string name(lines_[next_].text);
    const auto track = tracks_.begin(name, lines_[next_].number);
    if (!track) return tl::unexpected(track.error());
    ++next_;
    if (const auto colour = whole_number(fmt::format("the colour of \"{}\" is not a whole number", shortened(name)));
        !colour)
      return tl::unexpected(colour.error());
    const auto frames =
        whole_number(fmt::format("the number of frames of \"{}\" is not a whole number", shortened(name)));
    if (!frames) return tl::unexpected(frames.error());
    for (int k = 0; k < *frames; ++k)
      if (auto ok = read_frame(*track, name); !ok) return ok;
    return {};
  }

  // The origin is the bottom left corner.
  [[nodiscard]] Result<void> read_frame(std::size_t track, const std::string& name) {
    if (next_ == lines_.size())
      return wrong_line(file_, line_number(),
                        fmt::format("the file ends before the last frame of \"{}\"", shortened(name)));
    const TrackLine& line = lines_[next_++];
    const auto fields = fields_between(line.text, " \t");
    const auto frame = fields.size() == 3 ? track_frame(fields[0]) : std::nullopt;
    const auto x = fields.size() == 3 ? track_number(fields[1]) : std::nullopt;
    const auto y = fields.size() == 3 ? track_number(fields[2]) : std::nullopt;
    if (!frame || !x || !y)
      return wrong_line(file_, line.number, fmt::format("\"{}\": the line is not a frame, x and y", shortened(name)));
    return tracks_.add(track, *frame, {*x, settings_.height - *y}, line.number);
  }

  std::vector<TrackLine> lines_;
  const std::string& file_;
  const TrackFileSettings& settings_;
  TrackCollector tracks_;
  std::size_t next_ = 0;
};

}  // namespace

PointTracks read_equalizer_tracks(std::string_view text, const std::string& file, const TrackFileSettings& settings) {
  return EqualizerReader(track_lines(text, ""), file, settings).read();
}

}  // namespace contrejour::inline internal
