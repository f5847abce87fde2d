// SPDX-License-Identifier: Apache-2.0
// Picture -> PNG: docs/formats/images.md. libpng reports errors by longjmp: no objects with destructors live between
// setjmp and it.
#include <bit>
#include <csetjmp>
#include <cstring>
#include <new>

#include <fmt/format.h>
#include <png.h>

#include "image/formats.h"
#include "image/luminance_chroma.h"
#include "image/png_file.h"
#include "image/samples.h"

namespace contrejour::inline internal {
namespace {

constexpr int kCompressionLevel = 4;  // a third of level 6's time for files a few per cent larger
constexpr int kPngRowsBetweenCancelChecks = 64;

struct PngWriter {
  const PngSink& sink;
  std::optional<Error> error;
  char message[160] = "";
  png_structp png = nullptr;
  png_infop info = nullptr;

  explicit PngWriter(const PngSink& out) : sink(out) {}
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;
  ~PngWriter() { png_destroy_write_struct(&png, &info); }
};

[[noreturn]] void on_write_error(png_structp png, png_const_charp message) {
  auto* const writer = static_cast<PngWriter*>(png_get_error_ptr(png));
  std::strncpy(writer->message, message, sizeof writer->message - 1);
  png_longjmp(png, 1);
}

bool write_bytes(PngWriter& writer, const png_byte* from, std::size_t size) {
  const Result<void> written = writer.sink(std::span(reinterpret_cast<const std::byte*>(from), size));
  if (!written) writer.error = written.error();
  return written.has_value();
}

void on_write(png_structp png, png_bytep from, std::size_t size) {
  if (!write_bytes(*static_cast<PngWriter*>(png_get_io_ptr(png)), from, size)) png_error(png, "cannot write");
}

void on_flush(png_structp) {}

bool write_header(PngWriter& w, const PngLayout& layout) {
  static constexpr int kColourTypes[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                                         PNG_COLOR_TYPE_RGB_ALPHA};
  if (setjmp(png_jmpbuf(w.png)) != 0) return false;
  png_set_write_fn(w.png, &w, on_write, on_flush);
  png_set_user_limits(w.png, 0x7fffffff, 0x7fffffff);
  png_set_compression_level(w.png, kCompressionLevel);
  png_set_IHDR(w.png, w.info, static_cast<png_uint_32>(layout.width), static_cast<png_uint_32>(layout.height),
               layout.bits, kColourTypes[layout.channels - 1], PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(w.png, w.info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(w.png, w.info);
  if (layout.bits == 16 && std::endian::native == std::endian::little) png_set_swap(w.png);
  return true;
}

bool write_row(PngWriter& w, const std::byte* row) {
  if (setjmp(png_jmpbuf(w.png)) != 0) return false;
  png_write_row(w.png, reinterpret_cast<png_const_bytep>(row));
  return true;
}

bool write_end(PngWriter& w) {
  if (setjmp(png_jmpbuf(w.png)) != 0) return false;
  png_write_end(w.png, w.info);
  return true;
}

tl::unexpected<Error> failed(const PngWriter& writer, const SourcePosition& position) {
  if (writer.error) return tl::unexpected(*writer.error);
  return failure(ErrorCode::Io, fmt::format("cannot write: {}", writer.message), position);
}

}  // namespace

Result<void> write_png(const PngSink& sink, const SourcePosition& position, const PngLayout& layout,
                       const std::function<void(int y, std::byte* row)>& fill, const Context& context) {
  PngWriter writer(sink);
  writer.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &writer, on_write_error, ignore_png_warning);
  writer.info = writer.png == nullptr ? nullptr : png_create_info_struct(writer.png);
  if (writer.info == nullptr) throw std::bad_alloc();

  if (!write_header(writer, layout)) return failed(writer, position);
  std::vector<std::byte> row(static_cast<std::size_t>(layout.width) * static_cast<std::size_t>(layout.channels) *
                             static_cast<std::size_t>(layout.bits / 8));
  for (int y = 0; y < layout.height; ++y) {
    if (y % kPngRowsBetweenCancelChecks == 0 && context.cancelled())
      return failure(ErrorCode::Cancelled, "cancelled", position);
    fill(y, row.data());
    if (!write_row(writer, row.data())) return failed(writer, position);
  }
  if (!write_end(writer)) return failed(writer, position);
  if (context.cancelled()) return failure(ErrorCode::Cancelled, "cancelled", position);
  return {};
}

Result<void> write_png_file(OutputFile& file, const PngLayout& layout,
                            const std::function<void(int y, std::byte* row)>& fill, const Context& context) {
  return write_png([&file](std::span<const std::byte> bytes) { return file.write(bytes); },
                   {file.destination().string()}, layout, fill, context);
}

Result<void> write_picture_png(OutputFile& file, const Picture& picture, const Context& context) {
  if (is_luminance_chroma(picture)) return write_picture_png(file, with_rgb_channels(picture), context);
  // Colour and alpha; a PNG has no other channels.
  std::vector<std::size_t> sources;
  const bool grey = picture.rgb_source[0] == picture.rgb_source[2];
  for (std::size_t c = 0; c < (grey ? 1U : 3U); ++c) sources.push_back(static_cast<std::size_t>(picture.rgb_source[c]));
  for (std::size_t k = 0; k < picture.channels.size(); ++k)
    if (is_alpha(picture.channels[k])) sources.push_back(k);

  const SampleType type =
      picture.channels[sources[0]].type == SampleType::UInt8 ? SampleType::UInt8 : SampleType::UInt16;
  std::vector<std::vector<std::byte>> planes;
  for (const std::size_t k : sources) planes.push_back(samples_to_write(picture, k, type));

  const std::size_t size = size_of(type), channels = planes.size();
  const auto width = static_cast<std::size_t>(picture.data_window.width);
  const PngLayout layout{picture.data_window.width, picture.data_window.height, static_cast<int>(channels),
                         static_cast<int>(8 * size)};
  const auto fill = [&](int y, std::byte* row) {
    for (std::size_t c = 0; c < channels; ++c)
      for (std::size_t x = 0; x < width; ++x)
        std::memcpy(row + (x * channels + c) * size,
                    planes[c].data() + (static_cast<std::size_t>(y) * width + x) * size, size);
  };
  return write_png_file(file, layout, fill, context);
}

}  // namespace contrejour::inline internal
