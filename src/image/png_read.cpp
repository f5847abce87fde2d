// SPDX-License-Identifier: Apache-2.0
// PNG -> Picture: docs/formats/images.md. libpng reports errors by longjmp: no objects with destructors live between
// setjmp and it.
#include <bit>
#include <csetjmp>
#include <cstring>
#include <new>

#include <fmt/format.h>
#include <png.h>

#include "image/formats.h"
#include "image/png_file.h"
#include "image/samples.h"

namespace contrejour::inline internal {
namespace {

constexpr std::uint64_t kLargestDeflate = 1100;  // deflate compresses by 1032 at most (zlib's technical notes)
constexpr png_alloc_size_t kLargestChunk = 8U << 20;  // of those that are not pixels
constexpr png_uint_32 kLargestSide = 0x7fffffff;

struct PngReader {
  std::span<const std::byte> bytes;
  std::size_t position = 0;
  char message[160] = "";
  png_structp png = nullptr;
  png_infop info = nullptr;
  png_uint_32 width = 0, height = 0;
  int channels = 0, bits = 0;
  std::size_t row_bytes = 0;

  explicit PngReader(std::span<const std::byte> file) : bytes(file) {}
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;
  ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }
};

[[noreturn]] void on_read_error(png_structp png, png_const_charp message) {
  auto* const reader = static_cast<PngReader*>(png_get_error_ptr(png));
  std::strncpy(reader->message, message, sizeof reader->message - 1);
  png_longjmp(png, 1);
}

void on_read(png_structp png, png_bytep to, std::size_t size) {
  auto* const reader = static_cast<PngReader*>(png_get_io_ptr(png));
  if (size > reader->bytes.size() - reader->position) png_error(png, "the file is cut off");
  std::memcpy(to, reader->bytes.data() + reader->position, size);
  reader->position += size;
}

// Chunks that are not read here; a compressed one can expand a thousandfold.
constexpr png_byte kSkippedChunks[] = "tEXt\0zTXt\0iTXt\0iCCP\0sPLT\0eXIf\0hIST\0sCAL\0pCAL";

bool read_header(PngReader& r) {
  if (setjmp(png_jmpbuf(r.png)) != 0) return false;
  png_set_keep_unknown_chunks(r.png, PNG_HANDLE_CHUNK_NEVER, kSkippedChunks, sizeof kSkippedChunks / 5);
  png_set_read_fn(r.png, &r, on_read);
  png_set_user_limits(r.png, kLargestSide, kLargestSide);
  png_set_chunk_malloc_max(r.png, kLargestChunk);
  png_read_info(r.png, r.info);
  r.width = png_get_image_width(r.png, r.info);
  r.height = png_get_image_height(r.png, r.info);
  r.bits = png_get_bit_depth(r.png, r.info);
  return true;
}

// Any PNG as 1 to 4 channels of 8 or 16 bits. libpng allocates rows here, so the size must have been checked.
bool begin_pixels(PngReader& r) {
  if (setjmp(png_jmpbuf(r.png)) != 0) return false;
  png_set_expand(r.png);  // palette to RGB, fewer bits to 8, a transparent colour to alpha
  if constexpr (std::endian::native == std::endian::little) png_set_swap(r.png);
  png_set_interlace_handling(r.png);
  png_read_update_info(r.png, r.info);
  r.channels = png_get_channels(r.png, r.info);
  r.bits = png_get_bit_depth(r.png, r.info);
  r.row_bytes = png_get_rowbytes(r.png, r.info);
  return true;
}

bool read_rows(PngReader& r, png_bytep* rows) {
  if (setjmp(png_jmpbuf(r.png)) != 0) return false;
  png_read_image(r.png, rows);
  png_read_end(r.png, nullptr);
  return true;
}

tl::unexpected<Error> damaged(const PngReader& reader, const std::string& name) {
  return failure(ErrorCode::Parse, fmt::format("the PNG file is damaged: {}", reader.message), {name});
}

Result<void> check_size(const PngReader& r, const std::string& name, const ReadLimits& limits) {
  const std::uint64_t pixels = std::uint64_t{r.width} * r.height;
  // At most four channels, twice (interleaved and separate), and the linear image.
  const std::uint64_t bytes_per_pixel = 2 * 4 * (r.bits == 16 ? 2 : 1) + 3 * sizeof(float);
  if (pixels > limits.max_pixels || pixels * bytes_per_pixel > limits.max_bytes)
    return failure(ErrorCode::Unsupported,
                   fmt::format("the picture claims {} x {} pixels, more than the limit", r.width, r.height), {name});
  // A pixel takes a bit at least.
  if (pixels / 8 / kLargestDeflate > r.bytes.size())
    return failure(
        ErrorCode::Parse,
        fmt::format("the file is cut off: {} bytes cannot hold its {} x {} pixels", r.bytes.size(), r.width, r.height),
        {name});
  return {};
}

Picture picture_from_rows(const PngReader& r, const std::vector<std::byte>& interleaved) {
  static constexpr const char* kNames[4][4] = {{"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
  Picture picture;
  picture.data_window = picture.display_window = {0, 0, static_cast<int>(r.width), static_cast<int>(r.height)};
  const SampleType type = r.bits == 16 ? SampleType::UInt16 : SampleType::UInt8;
  const std::size_t size = size_of(type), count = std::size_t{r.width} * r.height;
  const auto channels = static_cast<std::size_t>(r.channels);
  for (std::size_t c = 0; c < channels; ++c) {
    PictureChannel channel{kNames[channels - 1][c], type, 1, 1, false, std::vector<std::byte>(count * size)};
    for (std::size_t i = 0; i < count; ++i)
      std::memcpy(channel.samples.data() + i * size, interleaved.data() + (i * channels + c) * size, size);
    picture.channels.push_back(std::move(channel));
  }
  const bool grey = channels < 3;
  picture.rgb_source = grey ? std::array<int, 3>{0, 0, 0} : std::array<int, 3>{0, 1, 2};
  picture.rgb = Image(picture.data_window.width, picture.data_window.height, 3);
  const std::vector<float> alpha = alpha_of(picture);
  for (std::size_t c = 0; c < 3; ++c) {
    const std::vector<float> values = decode_samples(picture.channels[grey ? 0 : c], Coding::Colour);
    for (std::size_t i = 0; i < count; ++i)
      picture.rgb.pixels[3 * i + c] = alpha.empty() ? values[i] : values[i] * alpha[i];
  }
  return picture;
}

Result<Picture> read(std::span<const std::byte> bytes, const std::string& name, const ReadLimits& limits) {
  PngReader reader(bytes);
  reader.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &reader, on_read_error, ignore_png_warning);
  reader.info = reader.png == nullptr ? nullptr : png_create_info_struct(reader.png);
  if (reader.info == nullptr) throw std::bad_alloc();
  if (!read_header(reader)) return damaged(reader, name);
  const Result<void> fits = check_size(reader, name, limits);
  if (!fits) return tl::unexpected(fits.error());
  if (!begin_pixels(reader)) return damaged(reader, name);

  std::vector<std::byte> interleaved(reader.row_bytes * reader.height);
  std::vector<png_bytep> rows(reader.height);
  for (std::size_t y = 0; y < rows.size(); ++y)
    rows[y] = reinterpret_cast<png_bytep>(interleaved.data() + y * reader.row_bytes);
  if (!read_rows(reader, rows.data())) return damaged(reader, name);
  return picture_from_rows(reader, interleaved);
}

}  // namespace

Result<Picture> read_png(std::span<const std::byte> bytes, const std::string& name, const ReadLimits& limits) {
  try {
    return read(bytes, name, limits);
  } catch (const std::bad_alloc&) {
    return failure(ErrorCode::Io, "not enough memory for this picture", {name});
  }
}

}  // namespace contrejour::inline internal
