// SPDX-License-Identifier: Apache-2.0
// OpenEXR -> Picture: docs/formats/images.md.
#include <new>
#include <vector>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfInputFile.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfVersion.h>
#include <fmt/format.h>

#include "image/exr_attributes.h"
#include "image/exr_choice.h"
#include "image/exr_limits.h"
#include "image/exr_streams.h"
#include "image/formats.h"
#include "image/luminance_chroma.h"
#include "image/picture_header.h"
#include "image/samples.h"

namespace contrejour::inline internal {
namespace {

constexpr std::size_t kVersionOffset = 4, kAttributesOffset = 8;

struct CheckedHeader {
  Imf::Header header;
  std::size_t size = 0;
};

// All checks that are possible before memory of the picture's size is allocated.
Result<CheckedHeader> read_header(std::span<const std::byte> bytes, const std::string& name, std::size_t size,
                                  const ReadLimits& limits) {
  CheckedHeader checked;
  checked.size = size;
  std::uint32_t version_field = 0;
  for (std::size_t i = 0; i < 4; ++i)
    version_field |= std::to_integer<std::uint32_t>(bytes[kVersionOffset + i]) << (8 * i);
  int version = static_cast<int>(version_field);
  MemoryInput stream(bytes, name);
  stream.seekg(kAttributesOffset);
  checked.header.readFrom(stream, version);
  checked.header.sanityCheck(Imf::isTiled(version));
  // The version field decides, not the presence of an attribute.
  if (!Imf::isTiled(version)) checked.header = without_attribute(checked.header, "tiles");
  if (checked.header.hasType() && Imf::isDeepData(checked.header.type()))
    return failure(ErrorCode::Unsupported, "deep OpenEXR pictures are not read; flatten it first", {name});
  const Result<void> fits = check_exr_size(checked.header, checked.size, bytes.size(), limits, name);
  if (!fits) return tl::unexpected(fits.error());
  return checked;
}

// All channels of an InputFile or an InputPart.
template <class File>
void read_channels(File& file, Picture& picture) {
  const Imath::Box2i window = file.header().dataWindow();
  Imf::FrameBuffer frame_buffer;
  for (auto i = file.header().channels().begin(); i != file.header().channels().end(); ++i) {
    const Imf::Channel& in = i.channel();
    PictureChannel channel{i.name(), sample_type_of(in.type), in.xSampling, in.ySampling, in.pLinear, {}};
    channel.samples.resize(sample_count(picture.data_window, in.xSampling, in.ySampling) * size_of(channel.type));
    frame_buffer.insert(i.name(),
                        Imf::Slice::Make(in.type, channel.samples.data(), window, 0, 0, in.xSampling, in.ySampling));
    picture.channels.push_back(std::move(channel));
  }
  file.setFrameBuffer(frame_buffer);
  file.readPixels(window.min.y, window.max.y);
}

Result<void> fill_rgb(const std::string& name, const std::string& layer, Picture& picture) {
  const auto found = colour_channels(picture, layer);
  if (!found) return no_colour(picture, layer, name);
  picture.rgb_source = found->rgb;
  picture.chroma_source = found->chroma;
  if (is_luminance_chroma(picture)) {
    if (!has_chroma_sizes(picture))
      return failure(ErrorCode::Unsupported,
                     "channels RY and BY have not half the size of Y; save the picture as R, G, B", {name});
    picture.rgb = rgb_of_luminance_chroma(picture);
    return {};
  }
  picture.rgb = Image(picture.data_window.width, picture.data_window.height, 3);
  const bool grey = found->rgb[0] == found->rgb[2];
  for (std::size_t c = 0; c < 3; ++c) {
    const PictureChannel& channel = picture.channels[static_cast<std::size_t>(found->rgb[c])];
    if (channel.x_sampling != 1 || channel.y_sampling != 1)
      return failure(ErrorCode::Unsupported,
                     fmt::format("colour channel '{}' is subsampled; save it at full size", channel.name), {name});
    if (grey && c > 0) break;
    const std::vector<float> values = decode_samples(channel, Coding::Colour);
    for (std::size_t i = 0; i < values.size(); ++i)
      for (std::size_t to = c; to < (grey ? 3 : c + 1); ++to) picture.rgb.pixels[3 * i + to] = values[i];
  }
  return {};
}

Picture empty_picture(const Imf::Header& header) {
  Picture picture;
  picture.data_window = window_of(header.dataWindow());
  picture.display_window = window_of(header.displayWindow());
  return picture;
}

Result<Picture> read_single(std::span<const std::byte> bytes, const std::string& name, std::size_t header_size,
                            const ReadOptions& options) {
  Result<CheckedHeader> checked = read_header(bytes, name, header_size, options.limits);
  if (!checked) return tl::unexpected(checked.error());
  if (const auto only = check_only_part(checked->header, name, options); !only) return tl::unexpected(only.error());
  Picture picture = empty_picture(checked->header);
  MemoryInput stream(bytes, name);
  Imf::InputFile file(stream);
  read_channels(file, picture);
  picture.header = std::make_shared<PictureHeader>(PictureHeader{std::move(checked->header)});
  const Result<void> filled = fill_rgb(name, options.layer, picture);
  if (!filled) return tl::unexpected(filled.error());
  return picture;
}

Result<Picture> read_part(std::span<const std::byte> bytes, const std::string& name, std::size_t header_size,
                          const ReadOptions& options) {
  MemoryInput stream(bytes, name);
  Imf::MultiPartInputFile file(stream);
  std::vector<const Imf::Header*> headers;
  for (int part = 0; part < file.parts(); ++part) headers.push_back(&file.header(part));
  const auto chosen = choose_part(headers, name, options);
  if (!chosen) return tl::unexpected(chosen.error());
  const Imf::Header& header = file.header(chosen->part);
  if (const auto fits = check_exr_size(header, header_size, bytes.size(), options.limits, name); !fits)
    return tl::unexpected(fits.error());
  Picture picture = empty_picture(header);
  Imf::InputPart part(file, chosen->part);
  read_channels(part, picture);
  const auto parts = std::make_shared<const PictureParts>(PictureParts{{bytes.begin(), bytes.end()}, chosen->part});
  picture.header = std::make_shared<PictureHeader>(PictureHeader{header, parts});
  const Result<void> filled = fill_rgb(name, chosen->layer, picture);
  if (!filled) return tl::unexpected(filled.error());
  return picture;
}

Result<Picture> read(std::span<const std::byte> bytes, const std::string& name, const ReadOptions& options) {
  const auto size = check_exr_header(bytes, name);
  if (!size) return tl::unexpected(size.error());
  return size->is_multi_part ? read_part(bytes, name, size->bytes, options)
                             : read_single(bytes, name, size->bytes, options);
}

}  // namespace

Result<Picture> read_exr(std::span<const std::byte> bytes, const std::string& name, const ReadOptions& options) {
  try {
    return read(bytes, name, options);
  } catch (const std::bad_alloc&) {
    return failure(ErrorCode::Io, "not enough memory for this picture", {name});
  } catch (const std::exception& e) {
    return failure(ErrorCode::Parse, fmt::format("the OpenEXR file is damaged: {}", e.what()), {name});
  } catch (...) {
    return failure(ErrorCode::Parse, "the OpenEXR file is damaged", {name});
  }
}

}  // namespace contrejour::inline internal
