// SPDX-License-Identifier: Apache-2.0
#include "vulkan/dirt_words.h"

#include <algorithm>
#include <array>
#include <bit>

#include "vulkan/stop_layout.h"

namespace contrejour::inline internal::vulkan {
namespace {

constexpr std::size_t kHeaderWords = sizeof(DirtHeader) / sizeof(std::uint32_t);

std::uint32_t bits_of(double number) { return std::bit_cast<std::uint32_t>(static_cast<float>(number)); }

void append_stroke(const DeviceStroke& s, std::vector<std::uint32_t>& words) {
  for (const double number :
       {s.middle_mm.x, s.middle_mm.y, s.along.x, s.along.y, s.half_length_mm, s.half_width_mm, s.radius_mm, s.opacity})
    words.push_back(bits_of(number));
}

}  // namespace

std::vector<std::uint32_t> dirt_words(const DeviceDirt& dirt) {
  std::vector<std::uint32_t> words(kHeaderWords);
  DirtHeader header;
  header.extent_mm = static_cast<float>(dirt.extent_mm);
  header.cells = dirt.cells;
  header.mm_a_unit = static_cast<float>(dirt.mm_a_unit);
  header.edges_per_mm = static_cast<float>(dirt.edges_per_mm);
  header.clear_radius_mm = static_cast<float>(dirt.clear_radius_mm);
  const auto here = [&] { return static_cast<std::uint32_t>(words.size()); };
  header.strokes_at = here();
  for (const DeviceStroke& stroke : dirt.strokes) append_stroke(stroke, words);
  header.first_at = here();
  words.insert(words.end(), dirt.first.begin(), dirt.first.end());
  header.of_cell_at = here();
  words.insert(words.end(), dirt.of_cell.begin(), dirt.of_cell.end());
  header.blocked_at = here();
  for (const float blocked : dirt.blocked_before) words.push_back(bits_of(blocked));
  header.dirty_at = here();
  words.insert(words.end(), dirt.dirty_before.begin(), dirt.dirty_before.end());
  if (dirt.picture) {
    header.picture_at = here();
    header.picture_width = static_cast<std::uint32_t>(dirt.picture->width());
    header.picture_height = static_cast<std::uint32_t>(dirt.picture->height());
    for (const float level : dirt.picture->levels()) words.push_back(bits_of(level));
  }
  const auto numbers = std::bit_cast<std::array<std::uint32_t, kHeaderWords>>(header);
  std::copy(numbers.begin(), numbers.end(), words.begin());
  return words;
}

}  // namespace contrejour::inline internal::vulkan
