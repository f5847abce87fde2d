// SPDX-License-Identifier: Apache-2.0
#include "vulkan/stop_tables.h"

#include <array>
#include <bit>
#include <vector>

#include "vulkan/dirt_words.h"
#include "vulkan/stop_layout.h"

namespace contrejour::inline internal::vulkan {
namespace {

constexpr std::size_t kRecordWords = sizeof(PatternRecord) / sizeof(std::uint32_t);

// Levels of an image pyramid (DownsampledPicture).
std::uint32_t levels_of(std::uint32_t side) {
  std::uint32_t levels = 1;
  for (; side % 2 == 0 && side > 2; side /= 2) ++levels;
  return levels;
}

// The records of all patterns, followed by their tables.
std::vector<std::uint32_t> pattern_words(const DevicePatterns& all) {
  std::vector<std::uint32_t> table_at;
  std::size_t size = kRecordWords * all.patterns.size();
  for (const std::vector<float>& table : all.tables) {
    table_at.push_back(static_cast<std::uint32_t>(size));
    size += table.size();
  }
  std::vector<std::uint32_t> words;
  words.reserve(size);
  for (const DevicePattern& p : all.patterns) {
    const PatternRecord record{table_at[p.table], p.side,       p.side == 0 ? 0 : levels_of(p.side),
                               p.outer_radius,    p.scale,      p.level_from,
                               p.roughness,       p.difference, p.uniform_from};
    const auto numbers = std::bit_cast<std::array<std::uint32_t, kRecordWords>>(record);
    words.insert(words.end(), numbers.begin(), numbers.end());
  }
  for (const std::vector<float>& table : all.tables)
    for (const float number : table) words.push_back(std::bit_cast<std::uint32_t>(number));
  return words;
}

}  // namespace

std::uint64_t StopTables::upload(DeviceContext& device, const DeviceInfo& info,
                                 const std::shared_ptr<const DevicePatterns>& patterns,
                                 const std::shared_ptr<const DeviceDirt>& dirt) {
  std::uint64_t uploaded = 0;
  const auto send = [&](Slot slot, const std::vector<std::uint32_t>& words, const char* too_large) {
    const std::uint64_t bytes = sizeof(std::uint32_t) * words.size();
    if (bytes > info.storage_range_bytes) throw vk::OutOfDeviceMemoryError(too_large);
    device.upload(slot, words);
    uploaded += bytes;
  };
  if (patterns && patterns != patterns_) {
    patterns_ = nullptr;  // until all is there
    send(Slot::Patterns, pattern_words(*patterns), "the stop patterns of a frame do not fit into the device's buffers");
    patterns_ = patterns;
  }
  if (dirt && dirt != dirt_) {
    dirt_ = nullptr;
    send(Slot::Dirt, dirt_words(*dirt), "the dirt of a lens does not fit into the device's buffers");
    dirt_ = dirt;
  }
  return uploaded;
}

std::uint32_t dirt_flags(const DeviceDirt* dirt) {
  return dirt == nullptr ? 0U : dirt->on_front ? kDirtOnFront : kDirtInStop;
}

std::uint32_t picture_number(const DevicePatterns* patterns) {
  return patterns != nullptr && patterns->picture != DevicePatterns::kNone ? patterns->picture + 1 : 0U;
}

}  // namespace contrejour::inline internal::vulkan
