// SPDX-License-Identifier: Apache-2.0
#include "sequence/track_files/track_lines.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include "base/near_name.h"
#include "base/trimmed.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kMaxTracks = 10000;  // as in a file of lights
constexpr double kLargestNumber = 1e9, kLargestFrame = 1e8;

// "lamp", "lamp 2", "lamp 3" for tracks that have the same name.
void make_names_unique(std::vector<PointTrack>& tracks) {
  std::set<std::string> names;
  std::map<std::string, int> copies;
  for (PointTrack& track : tracks) {
    int& copy = copies[track.name];
    std::string name = track.name;
    if (copy == 0) copy = 1;
    while (!names.insert(name).second) name = fmt::format("{} {}", track.name, ++copy);
    track.name = name;
  }
}

}  // namespace

std::vector<TrackLine> track_lines(std::string_view text, std::string_view comments, bool keep_spaces) {
  std::vector<TrackLine> lines;
  for (int number = 1; !text.empty(); ++number) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::string_view content = trimmed(line);
    if (content.empty() || comments.find(content.front()) != std::string_view::npos) continue;
    lines.push_back({keep_spaces ? line : content, number});
  }
  return lines;
}

std::vector<std::string_view> fields_between(std::string_view line, std::string_view separators) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t begin = line.find_first_not_of(separators);
    if (begin == std::string_view::npos) return fields;
    const std::size_t end = std::min(line.find_first_of(separators, begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    line.remove_prefix(end);
  }
}

std::vector<std::string_view> all_fields(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t end = line.find(separator);
    fields.push_back(trimmed(line.substr(0, end)));
    if (end == std::string_view::npos) return fields;
    line.remove_prefix(end + 1);
  }
}

std::optional<double> track_number(std::string_view field) {
  if (field.starts_with('+')) field.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size() || !(std::abs(value) <= kLargestNumber))
    return std::nullopt;
  return value;
}

std::optional<int> track_frame(std::string_view field) {
  const auto number = track_number(field);
  if (!number || *number != std::round(*number) || std::abs(*number) > kLargestFrame) return std::nullopt;
  return static_cast<int>(*number);
}

Result<void> check_frame_offset(int offset) {
  if (std::abs(static_cast<double>(offset)) <= kLargestFrame) return {};
  return invalid_argument(fmt::format("the offset of frames is not within {:g} of 0", kLargestFrame));
}

tl::unexpected<Error> wrong_line(const std::string& file, int line, std::string message) {
  return failure(ErrorCode::Parse, std::move(message), {file, line, 0});
}

Result<std::size_t> TrackCollector::begin(std::string_view name, int line) {
  if (tracks_.size() == kMaxTracks) return wrong_line(file_, line, fmt::format("more than {} tracks", kMaxTracks));
  const std::string own = name.empty() ? fmt::format("track {}", tracks_.size() + 1) : std::string(name);
  tracks_.push_back({own, {}, is_sampled_});
  points_.emplace_back();
  return tracks_.size() - 1;
}

Result<std::size_t> TrackCollector::named(std::string_view name, int line) {
  if (const auto at = by_name_.find(name); at != by_name_.end()) return at->second;
  const auto track = begin(name, line);
  if (track) by_name_.emplace(name, *track);
  return track;
}

Result<void> TrackCollector::add(std::size_t track, int frame, Vec2 position, int line) {
  const Vec2 uv{position.x / settings_.width, position.y / settings_.height};
  if (!points_[track].emplace(frame + settings_.frame_offset, uv).second)
    return wrong_line(file_, line,
                      fmt::format("frame {} of \"{}\" has two positions", frame, shortened(tracks_[track].name)));
  return {};
}

Result<std::vector<PointTrack>> TrackCollector::finish() {
  for (std::size_t k = 0; k < tracks_.size(); ++k)
    for (const auto& [frame, uv] : points_[k]) tracks_[k].keys.push_back({frame, uv});
  std::erase_if(tracks_, [](const PointTrack& track) { return track.keys.empty(); });
  if (tracks_.empty()) return failure(ErrorCode::Parse, "the file has no track with a position", {file_, 0, 0});
  make_names_unique(tracks_);
  return std::move(tracks_);
}

}  // namespace contrejour::inline internal
