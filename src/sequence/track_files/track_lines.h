// SPDX-License-Identifier: Apache-2.0
// Lines of a text with their numbers, fields of a line, and tracks made of what these say.
// Thread-safety: plain values and pure functions.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/expert/track_files.h"

namespace contrejour::inline internal {

struct TrackLine {
  std::string_view text;  // without spaces at its ends, unless they were asked for
  int number = 0;         // from 1
};

// Lines that are not empty and are no comment: none begins with one of `comments`.
[[nodiscard]] std::vector<TrackLine> track_lines(std::string_view text, std::string_view comments,
                                                 bool keep_spaces = false);

// The texts between separators; several in a row count as one, unless fields may be empty.
[[nodiscard]] std::vector<std::string_view> fields_between(std::string_view line, std::string_view separators);
[[nodiscard]] std::vector<std::string_view> all_fields(std::string_view line, char separator);

[[nodiscard]] std::optional<double> track_number(std::string_view field);  // finite, up to 1e9
[[nodiscard]] std::optional<int> track_frame(std::string_view field);      // whole, up to 1e8; "12.0" too

// Errors: InvalidArgument if frames with it could be beyond what an int has.
[[nodiscard]] Result<void> check_frame_offset(int offset);

[[nodiscard]] tl::unexpected<Error> wrong_line(const std::string& file, int line, std::string message);

// Collects points by the names of their tracks.
class TrackCollector {
 public:
  TrackCollector(const std::string& file, const TrackFileSettings& settings, bool is_sampled)
      : file_(file), settings_(settings), is_sampled_(is_sampled) {}

  // A new track, even if one has this name already. Errors: too many.
  [[nodiscard]] Result<std::size_t> begin(std::string_view name, int line);
  // The track of this name, which begins with its first point.
  [[nodiscard]] Result<std::size_t> named(std::string_view name, int line);
  // The position in pixels from the picture's top left corner. Errors: the frame has a point already.
  [[nodiscard]] Result<void> add(std::size_t track, int frame, Vec2 position_px, int line);

  // Errors: there is none. Tracks without a point are left out.
  [[nodiscard]] Result<std::vector<PointTrack>> finish();

 private:
  const std::string& file_;
  const TrackFileSettings& settings_;
  bool is_sampled_;
  std::vector<PointTrack> tracks_;
  std::vector<std::map<int, Vec2>> points_;
  std::map<std::string, std::size_t, std::less<>> by_name_;
};

}  // namespace contrejour::inline internal
