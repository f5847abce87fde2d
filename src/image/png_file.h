// SPDX-License-Identifier: Apache-2.0
// Rows of 8 or 16 bits as PNG.
#pragma once

#include <cstddef>
#include <functional>
#include <span>

#include "contrejour/expert/output_file.h"
#include "contrejour/image_io.h"

struct png_struct_def;

namespace contrejour::inline internal {

struct PngLayout {
  int width = 0, height = 0;
  int channels = 3;  // 1 grey, 2 with alpha, 3 RGB, 4 with alpha
  int bits = 8;      // or 16, native-endian in the rows
};

// Receives a file's bytes, in order.
using PngSink = std::function<Result<void>(std::span<const std::byte>)>;

// Calls fill(y, row) for each row from the top. Marked as sRGB. position: for errors. Errors: the sink's, Io,
// Cancelled.
[[nodiscard]] Result<void> write_png(const PngSink& sink, const SourcePosition& position, const PngLayout& layout,
                                     const std::function<void(int y, std::byte* row)>& fill, const Context& context);

// Ignores libpng's warnings, none of which makes a picture useless.
inline void ignore_png_warning(png_struct_def*, const char*) {}

// The same to a file.
[[nodiscard]] Result<void> write_png_file(OutputFile& file, const PngLayout& layout,
                                          const std::function<void(int y, std::byte* row)>& fill,
                                          const Context& context);

}  // namespace contrejour::inline internal
