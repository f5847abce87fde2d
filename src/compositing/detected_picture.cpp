// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/detected_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace contrejour {
namespace {

constexpr float kDimming = 0.3F;
// The colours of Okabe and Ito, which most people with a colour deficiency can distinguish; display values as linear
// light.
constexpr std::array<std::array<float, 3>, 8> kColours = {{{0.79F, 0.35F, 0.00F},
                                                           {0.09F, 0.46F, 0.81F},
                                                           {0.00F, 0.34F, 0.17F},
                                                           {0.87F, 0.78F, 0.05F},
                                                           {0.00F, 0.17F, 0.45F},
                                                           {0.67F, 0.11F, 0.00F},
                                                           {0.60F, 0.19F, 0.39F},
                                                           {0.85F, 0.85F, 0.85F}}};

// Calls visit(light, x, y, the three samples there) once for every pixel of a detected light.
template <class Visit>
void for_each_pixel(const Image& rgb, const Detection& found, const Visit& visit) {
  for (std::size_t light = 0; light < found.lights.size(); ++light) {
    const DetectedLight& l = found.lights[light];
    const Image part = picture_of_areas(rgb, found, l);
    for (int y = 0; y < part.height; ++y) {
      for (int x = 0; x < part.width; ++x) {
        const float* const pixel = part.pixels.data() + part.index(x, y);
        if (std::max({pixel[0], pixel[1], pixel[2]}) > 0.0F) visit(light, l.min_x + x, l.min_y + y, pixel);
      }
    }
  }
}

}  // namespace

Image pixels_of_lights(const Image& rgb, const Detection& found) {
  Image out(rgb.width, rgb.height);
  for_each_pixel(rgb, found, [&](std::size_t /*light*/, int x, int y, const float* pixel) {
    std::copy_n(pixel, 3, out.pixels.begin() + static_cast<std::ptrdiff_t>(out.index(x, y)));
  });
  return out;
}

Image false_colour_lights(const Image& rgb, const Detection& found, ColourSpace space) {
  Image out(rgb.width, rgb.height);
  for (std::size_t k = 0; k + 2 < rgb.pixels.size(); k += 3) {
    const double grey = luminance({rgb.pixels[k], rgb.pixels[k + 1], rgb.pixels[k + 2]}, space);
    std::fill_n(out.pixels.begin() + static_cast<std::ptrdiff_t>(k), 3,
                kDimming * static_cast<float>(std::isfinite(grey) ? std::clamp(grey, 0.0, 1.0) : 0.0));
  }
  for_each_pixel(rgb, found, [&](std::size_t light, int x, int y, const float* /*pixel*/) {
    std::copy_n(kColours[light % kColours.size()].begin(), 3,
                out.pixels.begin() + static_cast<std::ptrdiff_t>(out.index(x, y)));
  });
  return out;
}

}  // namespace contrejour
