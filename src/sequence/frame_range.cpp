// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/frame_range.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>

#include <fmt/format.h>

namespace contrejour {
namespace {

struct Part {
  std::int64_t first = 0, last = 0, step = 1;
};

// Takes a whole number from the front of the text.
std::optional<std::int64_t> take_number(std::string_view& text) {
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc()) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

bool take(std::string_view& text, char expected) {
  if (text.empty() || text.front() != expected) return false;
  text.remove_prefix(1);
  return true;
}

std::optional<Part> parse_part(std::string_view text) {
  Part part;
  const auto first = take_number(text);
  if (!first) return std::nullopt;
  part.first = part.last = *first;
  if (take(text, '-')) {
    const auto last = take_number(text);
    if (!last || *last < *first) return std::nullopt;
    part.last = *last;
    if (take(text, 'x')) {
      const auto step = take_number(text);
      if (!step || *step < 1) return std::nullopt;
      part.step = *step;
    }
  }
  return text.empty() ? std::optional(part) : std::nullopt;
}

// The index behind the longest run of equal steps that starts at `from`; a run of two frames counts only if they
// follow each other.
std::size_t end_of_run(const std::vector<int>& frames, std::size_t from) {
  std::size_t end = from + 1;
  if (end == frames.size()) return end;
  const int step = frames[end] - frames[from];
  while (end < frames.size() && frames[end] - frames[end - 1] == step) ++end;
  return end - from > 2 || step == 1 ? end : from + 1;
}

}  // namespace

Result<std::vector<int>> parse_frame_range(std::string_view text) {
  constexpr std::string_view kSeparators = ", \t";
  std::vector<int> frames;
  for (std::size_t at = text.find_first_not_of(kSeparators); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(kSeparators, at), text.size());
    const std::string_view word = text.substr(at, end - at);
    const auto part = parse_part(word);
    if (!part)
      return invalid_argument(fmt::format(
          "\"{}\" is not a range of frames; write FIRST-LAST, FIRST-LASTxSTEP, or numbers, separated by commas", word));
    if ((part->last - part->first) / part->step >= static_cast<std::int64_t>(kMaxFrames - frames.size()))
      return invalid_argument(fmt::format("the range \"{}\" has more than {} frames", text, kMaxFrames));
    for (std::int64_t frame = part->first; frame <= part->last; frame += part->step)
      frames.push_back(static_cast<int>(frame));
    at = text.find_first_not_of(kSeparators, end);
  }
  if (frames.empty()) return invalid_argument("the range of frames is empty; write e.g. 1001-1240");
  std::sort(frames.begin(), frames.end());
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

std::string frame_range_text(const std::vector<int>& frames) {
  std::string text;
  for (std::size_t from = 0; from < frames.size();) {
    const std::size_t end = end_of_run(frames, from);
    if (!text.empty()) text += ',';
    text += std::to_string(frames[from]);
    if (end - from > 1) {
      text += fmt::format("-{}", frames[end - 1]);
      const int step = frames[from + 1] - frames[from];
      if (step > 1) text += fmt::format("x{}", step);
    }
    from = end;
  }
  return text;
}

}  // namespace contrejour
