// SPDX-License-Identifier: Apache-2.0
#include "studio/ui/screenshot.h"

#include <cmath>
#include <vector>

#include <GLFW/glfw3.h>

#include "contrejour/image_io.h"

namespace contrejour::studio {
namespace {

float linear_of(unsigned char code) {
  const float v = static_cast<float>(code) / 255;
  return v <= 0.04045F ? v / 12.92F : std::pow((v + 0.055F) / 1.055F, 2.4F);
}

}  // namespace

// The library writes linear pictures; the codes come back as they were.
Result<void> write_screenshot(const std::string& file, int width, int height) {
  std::vector<unsigned char> codes(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, codes.data());
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < 3 * width; ++x)
      image.pixels[static_cast<std::size_t>(y * 3 * width + x)] =
          linear_of(codes[static_cast<std::size_t>((height - 1 - y) * 3 * width + x)]);
  return write_preview_png(std::filesystem::path(file), image, {.exposure_stops = 0, .roll_off_highlights = false});
}

}  // namespace contrejour::studio
