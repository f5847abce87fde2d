// SPDX-License-Identifier: Apache-2.0
#include "plates/plate_format.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/lower_extension.h"
#include "base/module.h"
#include "image/luminance_chroma.h"
#include "image/samples.h"

namespace contrejour::inline internal {
namespace {

using namespace std::string_view_literals;

constexpr std::array kSignatures{
    std::pair{"SDPX"sv, "dpx"},          std::pair{"XPDS"sv, "dpx"},       std::pair{"II*\0"sv, "tiff"},
    std::pair{"MM\0*"sv, "tiff"},        std::pair{"II+\0"sv, "tiff"},     std::pair{"MM\0+"sv, "tiff"},
    std::pair{"\xFF\xD8\xFF"sv, "jpeg"}, std::pair{"#?RADIANCE"sv, "hdr"}, std::pair{"#?RGBE"sv, "hdr"}};
constexpr std::array kExtensions{std::pair{".exr"sv, "exr"},   std::pair{".png"sv, "png"},
                                 std::pair{".dpx"sv, "dpx"},   std::pair{".tif"sv, "tiff"},
                                 std::pair{".tiff"sv, "tiff"}, std::pair{".jpg"sv, "jpeg"},
                                 std::pair{".jpeg"sv, "jpeg"}, std::pair{".hdr"sv, "hdr"}};
constexpr const char* kChannelNames[4][4] = {{"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
constexpr int kFilmBits = 10;  // of a new DPX

bool is_integer(SampleType type) { return type == SampleType::UInt8 || type == SampleType::UInt16; }

// The samples in which a format holds a picture whose colours are of this type.
SampleType stored_type(const std::string& format, SampleType type) {
  if (format == "hdr") return SampleType::Float;
  if (format == "jpeg") return SampleType::UInt8;
  if (is_integer(type)) return type;
  return format == "tiff" && type == SampleType::Float ? SampleType::Float : SampleType::UInt16;
}

PictureChannel channel_of_coded(const CodedImage& image, int c) {
  const auto channels = static_cast<std::size_t>(image.channels);
  const std::size_t size = size_of(image.type), count = image.samples.size() / size / channels;
  PictureChannel channel{kChannelNames[channels - 1][c], image.type, 1, 1, false, std::vector<std::byte>(count * size)};
  for (std::size_t i = 0; i < count; ++i)
    std::memcpy(channel.samples.data() + i * size,
                image.samples.data() + (i * channels + static_cast<std::size_t>(c)) * size, size);
  return channel;
}

}  // namespace

std::string module_format_of(std::span<const std::byte> first_bytes) {
  for (const auto& [signature, format] : kSignatures)
    if (first_bytes.size() >= signature.size() &&
        std::memcmp(first_bytes.data(), signature.data(), signature.size()) == 0)
      return format;
  return {};
}

std::string format_of_name(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  for (const auto& [ending, format] : kExtensions)
    if (extension == ending) return format;
  return {};
}

Result<const FormatModule*> format_module() {
  const auto function = module_function(kFormatModuleName, kFormatModuleFunction);
  if (!function)
    return failure(
        ErrorCode::Unsupported,
        fmt::format("DPX, TIFF, JPEG and HDR need OpenImageIO ({}); convert the picture to OpenEXR, or build "
                    "with libopenimageio-dev installed",
                    function.error().to_string()));
  const FormatModule* const module = reinterpret_cast<const FormatModule* (*)()>(*function)();
  if (std::string_view(module->version) == kFormatModuleVersion) return module;
  return failure(ErrorCode::Unsupported, "the module for OpenImageIO belongs to another version; install both anew");
}

bool stored_as_integers(const Picture& picture, const std::string& format) {
  return is_integer(stored_type(format, picture.channels[static_cast<std::size_t>(picture.rgb_source[0])].type));
}

Picture picture_of_coded(const CodedImage& image) {
  Picture picture;
  picture.data_window = picture.display_window = {0, 0, image.width, image.height};
  for (int c = 0; c < image.channels; ++c) picture.channels.push_back(channel_of_coded(image, c));
  const bool is_grey = image.channels < 3;
  picture.rgb_source = is_grey ? std::array<int, 3>{0, 0, 0} : std::array<int, 3>{0, 1, 2};
  picture.rgb = Image::unwritten(image.width, image.height, 3);
  const std::vector<float> alpha = is_integer(image.type) ? alpha_of(picture) : std::vector<float>{};
  for (std::size_t c = 0; c < 3; ++c) {
    const std::vector<float> values = decode_samples(picture.channels[is_grey ? 0 : c], Coding::Colour);
    for (std::size_t i = 0; i < values.size(); ++i)
      picture.rgb.pixels[3 * i + c] = alpha.empty() ? values[i] : values[i] * alpha[i];
  }
  return picture;
}

CodedImage coded_picture(const Picture& original, const std::string& format, const CodedImage* from) {
  if (is_luminance_chroma(original)) return coded_picture(with_rgb_channels(original), format, from);
  const Picture& picture = original;
  std::vector<std::size_t> sources;
  const bool is_grey = picture.rgb_source[0] == picture.rgb_source[2] && format != "hdr";
  for (std::size_t c = 0; c < (is_grey ? 1U : 3U); ++c)
    sources.push_back(static_cast<std::size_t>(picture.rgb_source[c]));
  if (format == "tiff" || format == "dpx")
    for (std::size_t k = 0; k < picture.channels.size(); ++k)
      if (is_alpha(picture.channels[k])) sources.push_back(k);
  CodedImage image;
  image.width = picture.data_window.width;
  image.height = picture.data_window.height;
  image.channels = static_cast<int>(sources.size());
  image.type = stored_type(format, picture.channels[sources[0]].type);
  image.bits = from != nullptr ? from->bits : format == "dpx" ? kFilmBits : static_cast<int>(8 * size_of(image.type));
  if (from != nullptr) image.header = from->header;
  const std::size_t size = size_of(image.type), channels = sources.size();
  const std::size_t count = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  image.samples.resize(count * channels * size);
  for (std::size_t c = 0; c < channels; ++c) {
    const std::vector<std::byte> plane = samples_to_write(picture, sources[c], image.type);
    for (std::size_t i = 0; i < count; ++i)
      std::memcpy(image.samples.data() + (i * channels + c) * size, plane.data() + i * size, size);
  }
  return image;
}

}  // namespace contrejour::inline internal
