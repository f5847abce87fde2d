// Rows of 8 or 16 bits to a PNG file.
#pragma once

#include <cstddef>
#include <functional>

#include "contrejour/image_io.h"
#include "contrejour/output_file.h"

namespace contrejour {

struct PngLayout {
  int width = 0, height = 0;
  int channels = 3;  // 1 grey, 2 with alpha, 3 RGB, 4 with alpha
  int bits = 8;      // or 16, native-endian in the rows
};

// Calls fill(y, row) for each row from the top. Marked as sRGB. Errors: Io, Cancelled.
[[nodiscard]] Result<void> write_png_file(OutputFile& file, const PngLayout& layout,
                                          const std::function<void(int y, std::byte* row)>& fill,
                                          const Context& context);

}  // namespace contrejour
