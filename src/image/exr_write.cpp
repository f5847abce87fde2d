// Picture -> OpenEXR: docs/formats/images.md.
#include <algorithm>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>
#include <fmt/format.h>

#include "image/exr_streams.h"
#include "image/formats.h"
#include "image/picture_header.h"
#include "image/samples.h"

namespace contrejour {
namespace {

constexpr int kRowsBetweenCancelChecks = 256;

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

// Coding anew with a lossy codec would change samples that nobody touched.
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

Imf::Header header_to_write(const Picture& picture) {
  Imf::Header header = without_attribute(header_of(picture), "chunkCount");  // it counts another file's chunks
  header.dataWindow() = box_of(picture.data_window);
  header.displayWindow() = box_of(picture.display_window);
  if (!picture.header || is_lossy(header.compression())) header.compression() = Imf::ZIP_COMPRESSION;
  if (header.hasTileDescription()) {
    header.tileDescription().mode = Imf::ONE_LEVEL;  // smaller levels would show the picture as it was
  } else if (header.lineOrder() == Imf::RANDOM_Y) {
    header.lineOrder() = Imf::INCREASING_Y;
  }
  header.channels() = Imf::ChannelList();
  for (const PictureChannel& channel : picture.channels)
    header.channels().insert(channel.name, Imf::Channel(pixel_type(exr_type(channel.type)), channel.x_sampling,
                                                        channel.y_sampling, channel.perceptually_linear));
  return header;
}

// Whether it came to the end; false when cancelled or the stream has failed.
bool write_scan_lines(OutputFileStream& stream, const Imf::Header& header, const Imf::FrameBuffer& frame_buffer,
                      int height, const Context& context) {
  Imf::OutputFile out(stream, header);
  out.setFrameBuffer(frame_buffer);
  for (int row = 0; row < height; row += kRowsBetweenCancelChecks) {
    if (context.cancelled() || stream.error()) return false;
    out.writePixels(std::min(kRowsBetweenCancelChecks, height - row));
  }
  return true;
}

bool write_tiles(OutputFileStream& stream, const Imf::Header& header, const Imf::FrameBuffer& frame_buffer,
                 const Context& context) {
  Imf::TiledOutputFile out(stream, header);
  out.setFrameBuffer(frame_buffer);
  const int rows = out.numYTiles();
  for (int i = 0; i < rows; ++i) {
    if (context.cancelled() || stream.error()) return false;
    const int row = header.lineOrder() == Imf::DECREASING_Y ? rows - 1 - i : i;
    out.writeTiles(0, out.numXTiles() - 1, row, row);
  }
  return true;
}

}  // namespace

Result<void> write_picture_exr(OutputFile& file, const Picture& picture, const Context& context) {
  const SourcePlace place{file.destination().string()};
  const Imf::Header header = header_to_write(picture);
  std::vector<std::vector<std::byte>> samples(picture.channels.size());
  Imf::FrameBuffer frame_buffer;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const PictureChannel& channel = picture.channels[k];
    const SampleType type = exr_type(channel.type);
    samples[k] = samples_to_write(picture, k, type);
    if (samples[k].size() != sample_count(picture.data_window, channel.x_sampling, channel.y_sampling) * size_of(type))
      return failure(ErrorCode::InvalidArgument,
                     fmt::format("channel '{}' does not fill the picture's window", channel.name), place);
    frame_buffer.insert(channel.name, Imf::Slice::Make(pixel_type(type), samples[k].data(), header.dataWindow(), 0, 0,
                                                       channel.x_sampling, channel.y_sampling));
  }

  OutputFileStream stream(file);
  bool finished = false;
  try {
    finished = header.hasTileDescription()
                   ? write_tiles(stream, header, frame_buffer, context)
                   : write_scan_lines(stream, header, frame_buffer, picture.data_window.height, context);
  } catch (const std::exception& e) {
    return failure(ErrorCode::Io, fmt::format("cannot write: {}", e.what()), place);
  }
  if (stream.error()) return tl::unexpected(*stream.error());
  if (!finished || context.cancelled()) return failure(ErrorCode::Cancelled, "cancelled", place);
  return {};
}

}  // namespace contrejour
