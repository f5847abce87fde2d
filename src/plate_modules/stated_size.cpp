// SPDX-License-Identifier: Apache-2.0
#include "plate_modules/stated_size.h"

namespace contrejour::inline internal {
namespace {

std::uint32_t big_endian(std::span<const std::byte> bytes, std::size_t at, std::size_t size) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < size; ++k) value = value << 8U | std::to_integer<std::uint32_t>(bytes[at + k]);
  return value;
}

// Markers without a length: fill, TEM, restarts, the image's begin and end.
bool stands_alone(std::uint32_t marker) { return marker <= 0x01 || (marker >= 0xD0 && marker <= 0xD9); }

// Start of frame, whichever way it is coded; among these codes are those of tables, which are not.
bool is_frame(std::uint32_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

}  // namespace

std::optional<StatedSize> stated_jpeg_size(std::span<const std::byte> bytes) {
  constexpr std::size_t kFrameBytes = 10;  // marker, length, precision, height, width, components
  for (std::size_t at = 0; at + kFrameBytes <= bytes.size();) {
    const std::uint32_t marker = big_endian(bytes, at + 1, 1);
    if (bytes[at] != std::byte{0xFF} || marker == 0xFF || stands_alone(marker)) {
      ++at;
      continue;
    }
    if (is_frame(marker))
      return StatedSize{static_cast<int>(big_endian(bytes, at + 7, 2)), static_cast<int>(big_endian(bytes, at + 5, 2)),
                        static_cast<int>(big_endian(bytes, at + 9, 1))};
    at += 2 + big_endian(bytes, at + 2, 2);
  }
  return std::nullopt;
}

bool claims_too_much_user_data(std::span<const std::byte> dpx) {
  constexpr std::size_t kUserSize = 32;
  constexpr std::uint32_t kUndefined = 0xFFFFFFFF;
  if (dpx.size() < kUserSize + 4) return true;
  const bool is_big_endian = dpx[0] == std::byte{'S'};
  std::uint32_t size = big_endian(dpx, kUserSize, 4);
  if (!is_big_endian) size = size << 24U | (size & 0xFF00U) << 8U | (size >> 8U & 0xFF00U) | size >> 24U;
  return size != kUndefined && size > dpx.size();
}

}  // namespace contrejour::inline internal
