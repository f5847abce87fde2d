// SPDX-License-Identifier: Apache-2.0
#include "image/exr_limits.h"

#include <algorithm>

#include <ImfChannelList.h>
#include <fmt/format.h>

#include "image/samples.h"

namespace contrejour::inline internal {
namespace {

// The largest compression ratio of a codec, rounded up. deflate: 1032 (zlib's technical notes), and PXR24 drops one
// byte in four before it; PIZ: runs of 255 values in 10 bits; B44A: 16 samples in 3 bytes; RLE: 128 bytes in 2. DWA's
// flat blocks leave one value of 64 to deflate.
std::uint64_t largest_compression(Imf::Compression compression) {
  switch (compression) {
    case Imf::NO_COMPRESSION: return 1;
    case Imf::RLE_COMPRESSION: return 64;
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION: return 16;
    case Imf::DWAA_COMPRESSION:
    case Imf::DWAB_COMPRESSION: return 65536;
    default: return 1500;
  }
}

std::uint64_t scan_lines_per_chunk(Imf::Compression compression) {
  switch (compression) {
    case Imf::ZIP_COMPRESSION:
    case Imf::PXR24_COMPRESSION: return 16;
    case Imf::PIZ_COMPRESSION:
    case Imf::B44_COMPRESSION:
    case Imf::B44A_COMPRESSION:
    case Imf::DWAA_COMPRESSION: return 32;
    case Imf::DWAB_COMPRESSION: return 256;
    default: return 1;
  }
}

std::uint64_t ceil_divide(std::uint64_t a, std::uint64_t b) { return (a + b - 1) / b; }

std::uint64_t chunk_count(const Imf::Header& header, const PixelWindow& window) {
  const auto width = static_cast<std::uint64_t>(window.width), height = static_cast<std::uint64_t>(window.height);
  if (!header.hasTileDescription()) return ceil_divide(height, scan_lines_per_chunk(header.compression()));
  const Imf::TileDescription& tile = header.tileDescription();
  return ceil_divide(width, std::max(1U, tile.xSize)) * ceil_divide(height, std::max(1U, tile.ySize));
}

std::uint64_t bytes_per_pixel(const Imf::Header& header) {
  std::uint64_t bytes = 0;
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i)
    bytes += size_of(sample_type_of(i.channel().type));
  return bytes;
}

std::uint64_t sample_bytes(const Imf::Header& header, const PixelWindow& window) {
  std::uint64_t bytes = 0;
  for (auto i = header.channels().begin(); i != header.channels().end(); ++i)
    bytes +=
        sample_count(window, i.channel().xSampling, i.channel().ySampling) * size_of(sample_type_of(i.channel().type));
  return bytes;
}

}  // namespace

SampleType sample_type_of(Imf::PixelType type) {
  return type == Imf::HALF ? SampleType::Half : type == Imf::FLOAT ? SampleType::Float : SampleType::UInt32;
}

PixelWindow window_of(const Imath::Box2i& box) {
  return {box.min.x, box.min.y, box.max.x - box.min.x + 1, box.max.y - box.min.y + 1};
}

Result<void> check_exr_size(const Imf::Header& header, std::uint64_t header_bytes, std::uint64_t file_bytes,
                            const ReadLimits& limits, const std::string& name) {
  const SourcePosition position{name};
  const PixelWindow window = window_of(header.dataWindow());
  const std::uint64_t pixels = static_cast<std::uint64_t>(window.width) * static_cast<std::uint64_t>(window.height);
  if (pixels > limits.max_pixels)
    return failure(ErrorCode::Unsupported,
                   fmt::format("the picture claims {} x {} pixels, more than the limit of {}", window.width,
                               window.height, limits.max_pixels),
                   position);
  const std::uint64_t bytes = sample_bytes(header, window);
  std::uint64_t tile_bytes = 0;  // OpenEXR holds one row of tiles
  if (header.hasTileDescription()) {
    const Imf::TileDescription& tile = header.tileDescription();
    if (tile.xSize > limits.max_pixels || tile.ySize > limits.max_pixels)
      return failure(ErrorCode::Parse, "the OpenEXR file's tiles are absurdly large", position);
    const std::uint64_t across = std::max<std::uint64_t>(tile.xSize, static_cast<std::uint64_t>(window.width));
    tile_bytes = across * tile.ySize * bytes_per_pixel(header);
  }
  const std::uint64_t image_bytes = 3 * sizeof(float) * pixels;
  if (std::max(bytes + image_bytes, tile_bytes) > limits.max_bytes)
    return failure(ErrorCode::Unsupported,
                   fmt::format("the picture needs more memory than the limit of {} bytes", limits.max_bytes), position);

  // Each chunk has an offset, a position and a size, and its codec limits the size of its data.
  const std::uint64_t chunks = chunk_count(header, window);
  const std::uint64_t min_bytes = header_bytes + chunks * (8 + 8) + bytes / largest_compression(header.compression());
  if (file_bytes < min_bytes)
    return failure(ErrorCode::Parse,
                   fmt::format("the file is cut off: {} bytes cannot hold its {} x {} pixels", file_bytes, window.width,
                               window.height),
                   position);
  return {};
}

}  // namespace contrejour::inline internal
