// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/frame_pattern.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <system_error>

#include <fmt/format.h>

namespace contrejour {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxDigits = 10;  // of an int

// Where in a text a frame's number stands.
struct Field {
  std::size_t at = 0, size = 0;
  int digits = 1;
};

// "%d", "%4d" or "%04d" at the front of the text.
std::optional<Field> printf_field(std::string_view text, std::size_t at) {
  const std::size_t digits_end = text.find_first_not_of("0123456789", at + 1);
  if (digits_end == std::string_view::npos || text[digits_end] != 'd') return std::nullopt;
  int digits = 1;
  std::from_chars(text.data() + at + 1, text.data() + digits_end, digits);
  return Field{at, digits_end + 1 - at, std::clamp(digits, 1, kMaxDigits)};
}

std::optional<Field> run_field(std::string_view text, std::size_t at, std::size_t min_size) {
  const std::size_t size = std::min(text.find_first_not_of(text[at], at), text.size()) - at;
  if (size < min_size) return std::nullopt;
  return Field{at, size, static_cast<int>(std::min<std::size_t>(size, kMaxDigits))};
}

std::optional<Field> field_at(std::string_view text, std::size_t at) {
  switch (text[at]) {
    case '%': return printf_field(text, at);
    case '#': return run_field(text, at, 1);
    case '@': return run_field(text, at, 2);
    default: return std::nullopt;
  }
}

std::vector<Field> fields_of(std::string_view name) {
  std::vector<Field> fields;
  const std::size_t folder = name.find_last_of("/\\");
  for (std::size_t at = folder == std::string_view::npos ? 0 : folder + 1; at < name.size();) {
    const auto field = field_at(name, at);
    if (field) fields.push_back(*field);
    at += field ? field->size : 1;
  }
  return fields;
}

// The frame whose file has this name, if there is one.
std::optional<int> frame_of(std::string_view name, const FramePattern& pattern, std::string_view before) {
  if (name.size() <= before.size() + pattern.after.size() || !name.starts_with(before) ||
      !name.ends_with(pattern.after))
    return std::nullopt;
  const std::string_view number = name.substr(before.size(), name.size() - before.size() - pattern.after.size());
  int frame = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), frame);
  if (error != std::errc() || end != number.data() + number.size()) return std::nullopt;
  return frame;
}

}  // namespace

bool is_frame_pattern(std::string_view name) { return !fields_of(name).empty(); }

Result<FramePattern> parse_frame_pattern(std::string_view name) {
  const std::vector<Field> fields = fields_of(name);
  if (fields.size() != 1)
    return invalid_argument(
        fmt::format("\"{}\" has {} places for the number of a frame; write it once, as #### or %04d", name,
                    fields.empty() ? "no" : "several"));
  const Field& field = fields.front();
  return FramePattern{std::string(name.substr(0, field.at)), std::string(name.substr(field.at + field.size)),
                      field.digits};
}

fs::path file_of_frame(const FramePattern& pattern, int frame) {
  return pattern.before + fmt::format("{:0{}}", frame, pattern.digits) + pattern.after;
}

Result<std::vector<int>> frames_on_disk(const FramePattern& pattern) {
  const fs::path whole(pattern.before + "0");
  const fs::path folder = whole.has_parent_path() ? whole.parent_path() : fs::path(".");
  const std::string last = whole.filename().string();
  const std::string before = last.substr(0, last.size() - 1);
  std::vector<int> frames;
  std::error_code error;
  for (fs::directory_iterator i(folder, error), end; !error && i != end; i.increment(error)) {
    const std::string name = i->path().filename().string();
    const auto frame = frame_of(name, pattern, before);
    if (frame && file_of_frame(pattern, *frame).filename() == i->path().filename()) frames.push_back(*frame);
  }
  if (error)
    return failure(ErrorCode::Io, fmt::format("cannot list the folder: {}", error.message()), {folder.string()});
  std::sort(frames.begin(), frames.end());
  return frames;
}

}  // namespace contrejour
