// SPDX-License-Identifier: Apache-2.0
// Picture -> OpenEXR: docs/formats/images.md.
#include <algorithm>
#include <stdexcept>
#include <utility>

#include <ImfChannelList.h>
#include <ImfDeepScanLineInputPart.h>
#include <ImfDeepScanLineOutputPart.h>
#include <ImfDeepTiledInputPart.h>
#include <ImfDeepTiledOutputPart.h>
#include <ImfFrameBuffer.h>
#include <ImfInputPart.h>
#include <ImfMultiPartInputFile.h>
#include <ImfMultiPartOutputFile.h>
#include <ImfOutputFile.h>
#include <ImfOutputPart.h>
#include <ImfPartType.h>
#include <ImfTiledInputPart.h>
#include <ImfTiledOutputFile.h>
#include <ImfTiledOutputPart.h>
#include <fmt/format.h>

#include "image/exr_streams.h"
#include "image/exr_threads.h"
#include "image/formats.h"
#include "image/luminance_chroma.h"
#include "image/picture_header.h"
#include "image/samples.h"

namespace contrejour::inline internal {
namespace {

constexpr int kExrRowsBetweenCancelChecks = 256;

// PNG's integers become linear: 8 bits fit a half, 16 need a float.
SampleType exr_type(SampleType type) {
  if (type == SampleType::UInt8) return SampleType::Half;
  return type == SampleType::UInt16 ? SampleType::Float : type;
}

Imf::PixelType pixel_type(SampleType type) {
  return type == SampleType::Half ? Imf::HALF : type == SampleType::Float ? Imf::FLOAT : Imf::UINT;
}

Imath::Box2i box_of(const PixelWindow& window) {
  return {{window.x, window.y}, {window.x + window.width - 1, window.y + window.height - 1}};
}

// Encoding again with a lossy codec would change samples that were not edited.
bool is_lossy(Imf::Compression compression) {
  switch (compression) {
    case Imf::PXR24_COMPRESSION:
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION:
    case Imf::DWAA_COMPRESSION:
    case Imf::DWAB_COMPRESSION: return true;
    default: return false;
  }
}

Imf::Compression compression_to_write(const Picture& picture, Imf::Compression of_header) {
  switch (picture.exr_compression) {
    case ExrCompression::None: return Imf::NO_COMPRESSION;
    case ExrCompression::Rle: return Imf::RLE_COMPRESSION;
    case ExrCompression::Zips: return Imf::ZIPS_COMPRESSION;
    case ExrCompression::Zip: return Imf::ZIP_COMPRESSION;
    case ExrCompression::Piz: return Imf::PIZ_COMPRESSION;
    case ExrCompression::AsRead: break;
  }
  return !picture.header || is_lossy(of_header) ? Imf::ZIP_COMPRESSION : of_header;
}

Imf::Header header_to_write(const Picture& picture) {
  Imf::Header header = without_attribute(header_of(picture), "chunkCount");  // it is the count of another file
  header.dataWindow() = box_of(picture.data_window);
  header.displayWindow() = box_of(picture.display_window);
  header.compression() = compression_to_write(picture, header.compression());
  if (header.hasTileDescription()) {
    header.tileDescription().mode = Imf::ONE_LEVEL;  // smaller levels would still contain the old picture
  } else if (header.lineOrder() == Imf::RANDOM_Y) {
    header.lineOrder() = Imf::INCREASING_Y;
  }
  header.channels() = Imf::ChannelList();
  for (const PictureChannel& channel : picture.channels)
    header.channels().insert(channel.name, Imf::Channel(pixel_type(exr_type(channel.type)), channel.x_sampling,
                                                        channel.y_sampling, channel.perceptually_linear));
  return header;
}

// The samples to write, by channel.
std::vector<std::vector<std::byte>> samples_of_channels(const Picture& picture) {
  std::vector<std::vector<std::byte>> samples(picture.channels.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const bool is_luminance = is_luminance_chroma(picture) && rgb_component(picture, k) >= 0;
    if (!is_luminance) samples[k] = samples_to_write(picture, k, exr_type(picture.channels[k].type));
  }
  if (!is_luminance_chroma(picture)) return samples;
  auto [luminance, red, blue] = luminance_chroma_to_write(picture);
  samples[static_cast<std::size_t>(picture.rgb_source[0])] = std::move(luminance);
  samples[static_cast<std::size_t>(picture.chroma_source[0])] = std::move(red);
  samples[static_cast<std::size_t>(picture.chroma_source[1])] = std::move(blue);
  return samples;
}

// Writes to an OutputFile or an OutputPart; false when cancelled or if the stream failed.
template <class File>
bool write_scan_lines(File& out, const OutputFileStream& stream, const Imf::FrameBuffer& frame_buffer, int height,
                      const Context& context) {
  out.setFrameBuffer(frame_buffer);
  for (int row = 0; row < height; row += kExrRowsBetweenCancelChecks) {
    if (context.cancelled() || stream.error()) return false;
    out.writePixels(std::min(kExrRowsBetweenCancelChecks, height - row));
  }
  return true;
}

// Writes to a TiledOutputFile or a TiledOutputPart.
template <class File>
bool write_tiles(File& out, const OutputFileStream& stream, const Imf::FrameBuffer& frame_buffer,
                 const Context& context) {
  out.setFrameBuffer(frame_buffer);
  const int rows = out.numYTiles();
  for (int i = 0; i < rows; ++i) {
    if (context.cancelled() || stream.error()) return false;
    const int row = out.header().lineOrder() == Imf::DECREASING_Y ? rows - 1 - i : i;
    out.writeTiles(0, out.numXTiles() - 1, row, row);
  }
  return true;
}

bool write_single(OutputFileStream& stream, const Imf::Header& header, const Imf::FrameBuffer& frame_buffer, int height,
                  const Context& context) {
  if (header.hasTileDescription()) {
    Imf::TiledOutputFile out(stream, header, exr_threads(context));
    return write_tiles(out, stream, frame_buffer, context);
  }
  Imf::OutputFile out(stream, header, exr_threads(context));
  return write_scan_lines(out, stream, frame_buffer, height, context);
}

template <class InputPart, class OutputPart>
void copy_part(Imf::MultiPartInputFile& from, Imf::MultiPartOutputFile& to, int part) {
  InputPart in(from, part);
  OutputPart out(to, part);
  out.copyPixels(in);
}

// Copies a part in its compressed form.
void copy_part(Imf::MultiPartInputFile& from, Imf::MultiPartOutputFile& to, int part) {
  const std::string& type = from.header(part).type();
  if (type == Imf::SCANLINEIMAGE) return copy_part<Imf::InputPart, Imf::OutputPart>(from, to, part);
  if (type == Imf::TILEDIMAGE) return copy_part<Imf::TiledInputPart, Imf::TiledOutputPart>(from, to, part);
  if (type == Imf::DEEPSCANLINE)
    return copy_part<Imf::DeepScanLineInputPart, Imf::DeepScanLineOutputPart>(from, to, part);
  if (type == Imf::DEEPTILE) return copy_part<Imf::DeepTiledInputPart, Imf::DeepTiledOutputPart>(from, to, part);
  throw std::runtime_error("a part of type '" + type + "' is not known");
}

// Writes the picture to its own part and copies the others.
bool write_parts(OutputFileStream& stream, const PictureParts& parts, const Imf::Header& header,
                 const Imf::FrameBuffer& frame_buffer, int height, const Context& context) {
  MemoryInput source(parts.file, "the picture that was read");
  Imf::MultiPartInputFile in(source);
  std::vector<Imf::Header> headers;
  for (int part = 0; part < in.parts(); ++part) headers.push_back(part == parts.part ? header : in.header(part));
  // The first part's display window and pixel aspect are used for all: the format requires them to be equal.
  Imf::MultiPartOutputFile out(stream, headers.data(), static_cast<int>(headers.size()), true, exr_threads(context));
  for (int part = 0; part < in.parts(); ++part) {
    if (context.cancelled() || stream.error()) return false;
    if (part != parts.part) {
      copy_part(in, out, part);
    } else if (header.hasTileDescription()) {
      Imf::TiledOutputPart own(out, part);
      if (!write_tiles(own, stream, frame_buffer, context)) return false;
    } else {
      Imf::OutputPart own(out, part);
      if (!write_scan_lines(own, stream, frame_buffer, height, context)) return false;
    }
  }
  return true;
}

}  // namespace

Result<void> write_picture_exr(OutputFile& file, const Picture& picture, const Context& context) {
  const SourcePosition position{file.destination().string()};
  const Imf::Header header = header_to_write(picture);
  std::vector<std::vector<std::byte>> samples = samples_of_channels(picture);
  Imf::FrameBuffer frame_buffer;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const PictureChannel& channel = picture.channels[k];
    const SampleType type = exr_type(channel.type);
    if (samples[k].size() != sample_count(picture.data_window, channel.x_sampling, channel.y_sampling) * size_of(type))
      return failure(ErrorCode::InvalidArgument,
                     fmt::format("channel '{}' does not fill the picture's window", channel.name), position);
    frame_buffer.insert(channel.name, Imf::Slice::Make(pixel_type(type), samples[k].data(), header.dataWindow(), 0, 0,
                                                       channel.x_sampling, channel.y_sampling));
  }

  OutputFileStream stream(file);
  bool finished = false;
  try {
    const PictureParts* const parts = picture.header ? picture.header->parts.get() : nullptr;
    const int height = picture.data_window.height;
    finished = parts != nullptr ? write_parts(stream, *parts, header, frame_buffer, height, context)
                                : write_single(stream, header, frame_buffer, height, context);
  } catch (const std::exception& e) {
    return failure(ErrorCode::Io, fmt::format("cannot write: {}", e.what()), position);
  }
  if (stream.error()) return tl::unexpected(*stream.error());
  if (!finished || context.cancelled()) return failure(ErrorCode::Cancelled, "cancelled", position);
  return {};
}

}  // namespace contrejour::inline internal
