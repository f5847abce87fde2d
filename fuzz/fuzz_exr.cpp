// SPDX-License-Identifier: Apache-2.0
// Any bytes: the OpenEXR reader must answer in bounded time and memory, and what it takes must fill its windows.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iterator>
#include <vector>

#include "contrejour/image_io.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  // The magic number costs the fuzzer nothing here, and keeps it out of the PNG reader.
  static constexpr std::byte kMagic[] = {std::byte{0x76}, std::byte{0x2f}, std::byte{0x31}, std::byte{0x01}};
  std::vector<std::byte> bytes(std::begin(kMagic), std::end(kMagic));
  const auto* const begin = reinterpret_cast<const std::byte*>(data);
  if (size > std::size(kMagic)) bytes.insert(bytes.end(), begin + std::size(kMagic), begin + size);
  contrejour::ReadOptions options;
  options.limits.max_bytes = std::uint64_t{64} << 20;
  const auto picture = contrejour::read_picture(bytes, "fuzz.exr", options);
  if (!picture) {
    if (picture.error().message.empty()) std::abort();
    return 0;
  }
  const auto pixels =
      static_cast<std::size_t>(picture->data_window.width) * static_cast<std::size_t>(picture->data_window.height);
  if (pixels == 0 || picture->rgb.pixels.size() != 3 * pixels) std::abort();
  for (const int source : picture->rgb_source)
    if (source < 0 || static_cast<std::size_t>(source) >= picture->channels.size()) std::abort();
  for (const int source : picture->chroma_source)
    if (source < -1 || source >= static_cast<int>(picture->channels.size())) std::abort();
  return 0;
}
