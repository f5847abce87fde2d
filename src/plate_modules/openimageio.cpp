// SPDX-License-Identifier: Apache-2.0
// DPX, TIFF, JPEG and Radiance HDR by OpenImageIO. No other of its readers is used, and a file's claims are checked
// before its pixels are read.
#include <algorithm>
#include <exception>
#include <string>
#include <utility>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include "plate_modules/stated_size.h"
#include "plates/format_module.h"

namespace contrejour::inline internal {
namespace {

constexpr std::uint64_t kLargestRatio = 1100;  // of compression, by deflate (zlib's technical notes)
constexpr int kMaxChannels = 4;

OIIO::TypeDesc type_of(SampleType type) {
  switch (type) {
    case SampleType::UInt8: return OIIO::TypeDesc::UINT8;
    case SampleType::UInt16: return OIIO::TypeDesc::UINT16;
    case SampleType::Half: return OIIO::TypeDesc::HALF;
    case SampleType::UInt32:
    case SampleType::Float: break;
  }
  return OIIO::TypeDesc::FLOAT;
}

SampleType sample_type(OIIO::TypeDesc type) {
  switch (type.basetype) {
    case OIIO::TypeDesc::UINT8: return SampleType::UInt8;
    case OIIO::TypeDesc::HALF: return SampleType::Half;
    case OIIO::TypeDesc::FLOAT:
    case OIIO::TypeDesc::DOUBLE: return SampleType::Float;
    default: return SampleType::UInt16;
  }
}

std::string reason(const std::string& message) {
  std::string line = message.substr(0, message.find('\n'));
  return line.empty() ? "the file is damaged" : line;
}

Result<void> check_claims(const OIIO::ImageSpec& spec, std::size_t file_bytes, const ReadLimits& limits) {
  const auto claim = [&] {
    return fmt::format("{} x {} pixels of {} channels", spec.width, spec.height, spec.nchannels);
  };
  if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1)
    return failure(ErrorCode::Parse, fmt::format("the file is damaged: it claims {}", claim()));
  if (spec.nchannels > kMaxChannels)
    return failure(
        ErrorCode::Unsupported,
        fmt::format("it has {} channels; give a picture with at most four, or an OpenEXR file", spec.nchannels));
  const std::uint64_t pixels = std::uint64_t(spec.width) * std::uint64_t(spec.height);
  const std::uint64_t tile = std::uint64_t(std::max(1, spec.tile_width)) * std::uint64_t(std::max(1, spec.tile_height));
  const std::uint64_t values = std::uint64_t(spec.nchannels) * std::max<std::uint64_t>(1, spec.format.size());
  if (pixels > limits.max_pixels || tile > limits.max_pixels || pixels * (2 * values + 24) > limits.max_bytes)
    return failure(ErrorCode::Unsupported, fmt::format("the picture claims {}, more than the limit", claim()));
  if (pixels * values / kLargestRatio > file_bytes)
    return failure(ErrorCode::Parse,
                   fmt::format("the file is cut off: {} bytes cannot hold its {}", file_bytes, claim()));
  return {};
}

// The fewest bytes of a DPX that holds its pixels uncompressed (SMPTE 268M-2003): OpenImageIO takes what a file that is
// cut off lacks for black. 0 where the file is compressed or its components are not whole pixels.
std::uint64_t least_dpx_bytes(const OIIO::ImageSpec& spec, std::span<const std::byte> bytes) {
  constexpr std::size_t kElement = 780, kElementEnd = 816;
  if (bytes.size() < kElementEnd) return ~std::uint64_t{0};
  const bool is_big_endian = bytes[0] == std::byte{'S'};
  const auto number = [&](std::size_t at, int size) {
    std::uint64_t value = 0;
    for (int k = 0; k < size; ++k) {
      const std::size_t next = at + static_cast<std::size_t>(is_big_endian ? k : size - 1 - k);
      value = value << 8U | std::to_integer<std::uint64_t>(bytes[next]);
    }
    return value;
  };
  const std::uint64_t descriptor = number(kElement + 20, 1), bits = number(kElement + 23, 1);
  const std::uint64_t packing = number(kElement + 24, 2), encoding = number(kElement + 26, 2);
  const bool has_whole_pixels = descriptor == 50 || descriptor == 51 || descriptor == 52 || descriptor <= 8;
  if (encoding != 0 || !has_whole_pixels) return 0;
  const std::uint64_t values = std::uint64_t(spec.width) * std::uint64_t(spec.nchannels);
  const bool is_filled = packing != 0;
  std::uint64_t row = (values * bits + 7) / 8;
  if (is_filled && bits == 10) row = (values + 2) / 3 * 4;
  if (is_filled && bits == 12) row = values * 2;
  return number(4, 4) + row * std::uint64_t(spec.height);
}

// The sizes that the file states are checked before OpenImageIO opens it, too.
Result<void> check_before_opening(std::span<const std::byte> bytes, const std::string& format,
                                  const ReadLimits& limits) {
  if (format == "dpx" && claims_too_much_user_data(bytes))
    return failure(ErrorCode::Parse, "the file is damaged: it claims more user data than it has bytes");
  if (format != "jpeg") return {};
  const auto stated = stated_jpeg_size(bytes);
  if (!stated) return failure(ErrorCode::Parse, "the file is damaged: it has no frame");
  return check_claims({stated->width, stated->height, stated->channels, OIIO::TypeDesc::UINT8}, bytes.size(), limits);
}

Result<CodedImage> read(std::span<const std::byte> bytes, const std::string& format, const ReadLimits& limits) {
  OIIO::Filesystem::IOMemReader memory(const_cast<std::byte*>(bytes.data()), bytes.size());
  const auto input = OIIO::ImageInput::create(format);
  if (!input) return failure(ErrorCode::Unsupported, fmt::format("this OpenImageIO does not read {}", format));
  if (auto ok = check_before_opening(bytes, format, limits); !ok) return tl::unexpected(ok.error());
  OIIO::ImageSpec settings, spec;
  settings.attribute("oiio:UnassociatedAlpha", 1);
  if (!input->set_ioproxy(&memory) || !input->open("picture." + format, spec, settings))
    return failure(ErrorCode::Parse, reason(input->geterror()));
  if (auto ok = check_claims(spec, bytes.size(), limits); !ok) return tl::unexpected(ok.error());
  if (format == "dpx" && least_dpx_bytes(spec, bytes) > bytes.size())
    return failure(ErrorCode::Parse, fmt::format("the file is cut off: {} bytes cannot hold its {} x {} pixels",
                                                 bytes.size(), spec.width, spec.height));
  CodedImage image;
  image.width = spec.width;
  image.height = spec.height;
  image.channels = spec.nchannels;
  image.type = sample_type(spec.format);
  image.bits = spec.get_int_attribute("oiio:BitsPerSample", static_cast<int>(8 * type_of(image.type).size()));
  image.is_film_log = spec.get_string_attribute("oiio:ColorSpace") == "KodakLog";
  image.samples.resize(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels) * type_of(image.type).size());
  if (!input->read_image(0, 0, 0, spec.nchannels, type_of(image.type), image.samples.data()))
    return failure(ErrorCode::Parse, reason(input->geterror()));
  image.header = std::make_shared<const OIIO::ImageSpec>(spec);
  return image;
}

// The settings of a new file: what the picture's own file stated, if it had this form. Padding is left out: a DPX may
// claim any, and OpenImageIO's writer trusts it.
OIIO::ImageSpec spec_of(const CodedImage& image) {
  const auto* const stated = static_cast<const OIIO::ImageSpec*>(image.header.get());
  OIIO::ImageSpec spec(image.width, image.height, image.channels, type_of(image.type));
  if (stated != nullptr) spec.extra_attribs = stated->extra_attribs;
  for (const char* const padding : {"dpx:EndOfLinePadding", "dpx:EndOfImagePadding"}) spec.erase_attribute(padding);
  spec.attribute("oiio:BitsPerSample", image.bits);
  if (image.channels == 2 || image.channels == 4) {
    spec.alpha_channel = image.channels - 1;
    spec.attribute("oiio:UnassociatedAlpha", 1);
  }
  return spec;
}

Result<std::vector<std::byte>> write(const CodedImage& image, const std::string& format) {
  OIIO::Filesystem::IOVecOutput memory;
  const auto output = OIIO::ImageOutput::create(format);
  if (!output) return failure(ErrorCode::Unsupported, fmt::format("this OpenImageIO does not write {}", format));
  OIIO::ImageSpec spec = spec_of(image);
  if (format == "jpeg" && spec.find_attribute("Compression") == nullptr) spec.attribute("Compression", "jpeg:95");
  if (!output->set_ioproxy(&memory) || !output->open("picture." + format, spec) ||
      !output->write_image(type_of(image.type), image.samples.data()) || !output->close())
    return failure(ErrorCode::Io, reason(output->geterror()));
  const auto* const first = reinterpret_cast<const std::byte*>(memory.buffer().data());
  return std::vector<std::byte>(first, first + memory.buffer().size());
}

// OpenImageIO reports most errors, and throws on some. It starts no threads: the library's own come from base/tasks.h.
template <class Call>
auto guarded(const Call& call) -> decltype(call()) {
  try {
    OIIO::attribute("threads", 1);
    return call();
  } catch (const std::exception& error) {
    return failure(ErrorCode::Parse, reason(error.what()));
  }
}

}  // namespace

extern "C" CONTREJOUR_API const FormatModule* contrejour_format_module() {
  static const FormatModule module{
      kFormatModuleVersion,
      [](std::span<const std::byte> bytes, const std::string& format, const ReadLimits& limits) {
        return guarded([&] { return read(bytes, format, limits); });
      },
      [](const CodedImage& image, const std::string& format) { return guarded([&] { return write(image, format); }); }};
  return &module;
}

}  // namespace contrejour::inline internal
