// SPDX-License-Identifier: Apache-2.0
// Any bytes: the PNG reader must answer in bounded time and memory, and what it takes must fill its windows.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <vector>

#include "contrejour/image_io.h"

namespace {

std::uint32_t crc_of(const std::byte* from, std::size_t size) {  // PNG specification, annex D
  std::uint32_t crc = 0xffffffff;
  for (std::size_t i = 0; i < size; ++i) {
    crc ^= std::to_integer<std::uint32_t>(from[i]);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xedb88320U : 0U);
  }
  return ~crc;
}

// Right checksums let changed chunks get past libpng's first look.
void mend_checksums(std::vector<std::byte>& bytes) {
  for (std::size_t at = 8; at + 12 <= bytes.size();) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = length << 8 | std::to_integer<std::size_t>(bytes[at + i]);
    if (length > bytes.size() - at - 12) return;
    const std::uint32_t crc = crc_of(bytes.data() + at + 4, length + 4);
    for (std::size_t i = 0; i < 4; ++i) bytes[at + 8 + length + i] = static_cast<std::byte>(crc >> (24 - 8 * i));
    at += length + 12;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // The magic number costs the fuzzer nothing here, and keeps it out of the OpenEXR reader.
  static constexpr std::byte kMagic[] = {std::byte{0x89}, std::byte{0x50}, std::byte{0x4e}, std::byte{0x47}};
  std::vector<std::byte> bytes(std::begin(kMagic), std::end(kMagic));
  const auto* const begin = reinterpret_cast<const std::byte*>(data);
  if (size > std::size(kMagic)) bytes.insert(bytes.end(), begin + std::size(kMagic), begin + size);
  mend_checksums(bytes);
  contrejour::ReadOptions options;
  options.limits.max_bytes = std::uint64_t{64} << 20;
  const auto picture = contrejour::read_picture(bytes, "fuzz.png", options);
  if (!picture) {
    if (picture.error().message.empty()) std::abort();
    return 0;
  }
  const auto pixels =
      static_cast<std::size_t>(picture->data_window.width) * static_cast<std::size_t>(picture->data_window.height);
  if (pixels == 0 || picture->rgb.pixels.size() != 3 * pixels) std::abort();
  for (const int source : picture->rgb_source)
    if (source < 0 || static_cast<std::size_t>(source) >= picture->channels.size()) std::abort();
  return 0;
}
