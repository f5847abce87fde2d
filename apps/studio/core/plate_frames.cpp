// SPDX-License-Identifier: Apache-2.0
#include "studio/core/plate_frames.h"

#include <algorithm>
#include <system_error>

#include "contrejour/expert/frame_pattern.h"

namespace contrejour::studio {

bool is_plate_sequence(const std::string& file) {
  std::error_code code;
  return is_frame_pattern(file) && !std::filesystem::exists(file, code);
}

SessionPlate plate_at(const SessionPlate& plate, int frame) {
  if (!is_plate_sequence(plate.file)) return plate;
  const auto pattern = parse_frame_pattern(plate.file);
  if (!pattern) return plate;
  SessionPlate one = plate;
  one.file = file_of_frame(*pattern, frame).string();
  return one;
}

Result<std::vector<int>> frames_of_plate(const SessionPlate& plate) {
  if (!is_plate_sequence(plate.file)) return std::vector<int>{};
  const auto pattern = parse_frame_pattern(plate.file);
  if (!pattern) return tl::unexpected(pattern.error());
  return frames_on_disk(*pattern);
}

std::vector<int> missing_frames(const std::vector<int>& present, int first, int last) {
  std::vector<int> missing;
  for (int frame = first; frame <= last; ++frame)
    if (!std::binary_search(present.begin(), present.end(), frame)) missing.push_back(frame);
  return missing;
}

std::optional<std::string> sequence_of_file(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  const auto last_other = stem.find_last_not_of("0123456789");
  const std::size_t first_digit = last_other == std::string::npos ? 0 : last_other + 1;
  const std::size_t digits = stem.size() - first_digit;
  if (digits == 0) return std::nullopt;
  const std::string name = stem.substr(0, first_digit) + std::string(digits, '#') + file.extension().string();
  const std::string pattern = (file.parent_path() / name).string();
  const auto parsed = parse_frame_pattern(pattern);
  if (!parsed) return std::nullopt;
  const auto frames = frames_on_disk(*parsed);
  if (!frames || frames->size() < 2) return std::nullopt;
  return pattern;
}

}  // namespace contrejour::studio
