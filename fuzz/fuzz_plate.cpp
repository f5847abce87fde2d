// SPDX-License-Identifier: Apache-2.0
// Any bytes as DPX, TIFF, JPEG or HDR: the module for OpenImageIO must answer in bounded time and memory, what it takes
// must have all its samples, and a small picture must go back to its format with what its file stated, as `apply`
// writes it. The harness is linked with the module itself; OpenImageIO and its libraries are Debian's, so that broken
// memory is found where they ask for it or end the program.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "image/samples.h"
#include "plates/plate_format.h"

namespace contrejour::inline internal {
extern "C" const FormatModule* contrejour_format_module();
}

using namespace contrejour;

namespace {

// Bytes without a signature get one of these, so that none is lost on the choice of a format.
std::string signed_as(std::vector<std::byte>& bytes) {
  const std::string format = module_format_of(bytes);
  if (!format.empty() || bytes.empty()) return format;
  static const std::string kSignatures[] = {"SDPX", std::string("II*\0", 4), "\xFF\xD8\xFF", "#?RADIANCE\n"};
  const std::string& signature = kSignatures[std::to_integer<std::size_t>(bytes[0]) % std::size(kSignatures)];
  bytes.resize(std::max(bytes.size(), signature.size()));
  std::transform(signature.begin(), signature.end(), bytes.begin(), [](char c) { return static_cast<std::byte>(c); });
  return module_format_of(bytes);
}

void write_back(const CodedImage& image, const Picture& picture, const std::string& format) {
  const CodedImage again = coded_picture(picture, format, &image);
  const auto bytes = contrejour_format_module()->write(again, format);
  if (bytes ? bytes->empty() : bytes.error().message.empty()) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr int kSmall = 64;
  const auto* const begin = reinterpret_cast<const std::byte*>(data);
  std::vector<std::byte> bytes(begin, begin + size);
  const std::string format = signed_as(bytes);
  if (format.empty()) return 0;
  ReadLimits limits;
  limits.max_bytes = std::uint64_t{64} << 20;
  const auto image = contrejour_format_module()->read(bytes, format, limits);
  if (!image) {
    if (image.error().message.empty()) std::abort();
    return 0;
  }
  const auto samples = static_cast<std::size_t>(image->width) * static_cast<std::size_t>(image->height) *
                       static_cast<std::size_t>(image->channels);
  if (samples == 0 || image->channels > 4 || image->samples.size() != samples * size_of(image->type)) std::abort();
  const Picture picture = picture_of_coded(*image);
  if (picture.rgb.width != image->width || picture.rgb.height != image->height) std::abort();
  if (image->width <= kSmall && image->height <= kSmall) write_back(*image, picture, format);
  return 0;
}
