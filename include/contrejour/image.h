// Scene-linear float images, interleaved, rows from the top. Values in, values out.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace contrejour {

struct Image {
  int width = 0;
  int height = 0;
  int channels = 3;
  std::vector<float> pixels;  // [(y * width + x) * channels + c]

  Image() = default;
  Image(int w, int h, int c = 3)
      : width(w), height(h), channels(c),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) * static_cast<std::size_t>(c)) {}

  [[nodiscard]] std::size_t index(int x, int y, int c = 0) const {
    return (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)) *
               static_cast<std::size_t>(channels) +
           static_cast<std::size_t>(c);
  }
  [[nodiscard]] float& at(int x, int y, int c = 0) { return pixels[index(x, y, c)]; }
  [[nodiscard]] float at(int x, int y, int c = 0) const { return pixels[index(x, y, c)]; }
  [[nodiscard]] std::span<float> row(int y) {
    return {pixels.data() + index(0, y), static_cast<std::size_t>(width) * static_cast<std::size_t>(channels)};
  }
  [[nodiscard]] std::span<const float> row(int y) const {
    return {pixels.data() + index(0, y), static_cast<std::size_t>(width) * static_cast<std::size_t>(channels)};
  }
};

}  // namespace contrejour
