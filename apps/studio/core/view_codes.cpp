// SPDX-License-Identifier: Apache-2.0
#include "studio/core/view_codes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "contrejour/expert/plate.h"

namespace contrejour::studio {
namespace {

constexpr float kRollOffFrom = 0.8F;  // as in previews (image_io.h)
constexpr int kTableSize = 4096;
constexpr float kTableEnd = 2.0F;  // all curves are 255 beyond, to half a code

float roll_off(float value) {
  constexpr float headroom = 1 - kRollOffFrom;
  return value > kRollOffFrom ? 1 - headroom * std::exp((kRollOffFrom - value) / headroom) : value;
}

float srgb(float value) { return value <= 0.0031308F ? 12.92F * value : 1.055F * std::pow(value, 1 / 2.4F) - 0.055F; }

// Values by their square root, so that shadows have codes enough.
using CodeTable = std::array<std::uint8_t, kTableSize>;

CodeTable code_table(bool rolls_off) {
  CodeTable table{};
  for (int k = 0; k < kTableSize; ++k) {
    const float root = std::sqrt(kTableEnd) * static_cast<float>(k) / (kTableSize - 1);
    const float value = root * root;
    const float shown = srgb(std::fmin(1.0F, rolls_off ? roll_off(value) : value));
    table[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(std::lround(255 * shown));
  }
  return table;
}

std::uint32_t code_of(const CodeTable& table, float value) {
  if (!(value > 0)) return table[0];
  constexpr float scale = (kTableSize - 1) / 1.41421356F;
  const auto index = static_cast<std::size_t>(std::fmin(std::sqrt(value) * scale + 0.5F, kTableSize - 1.0F));
  return table[index];
}

std::uint32_t packed(std::uint32_t r, std::uint32_t g, std::uint32_t b) { return r | g << 8U | b << 16U | 0xFF000000U; }

// Mid grey is grey; a colour for each stop, from violet (6 below) over green to white (6 above).
std::uint32_t false_colour(float luminance) {
  if (!(luminance > 0)) return packed(0, 0, 0);
  static constexpr std::array<std::array<std::uint32_t, 3>, 13> kStops = {{{18, 10, 36},
                                                                           {42, 20, 84},
                                                                           {58, 42, 140},
                                                                           {48, 84, 168},
                                                                           {40, 128, 164},
                                                                           {48, 152, 120},
                                                                           {128, 128, 128},
                                                                           {150, 176, 60},
                                                                           {216, 188, 48},
                                                                           {236, 140, 40},
                                                                           {232, 84, 44},
                                                                           {240, 120, 140},
                                                                           {255, 255, 255}}};
  const float stop = std::log2(luminance / 0.18F) + 6.5F;
  const auto& c = kStops[static_cast<std::size_t>(std::clamp(stop, 0.0F, 12.0F))];
  return packed(c[0], c[1], c[2]);
}

// The window shows Rec.709, as PNG previews do of pictures in that space.
Image in_rec709(Image image) {
  std::array<Rgb, 3> columns;
  for (std::size_t c = 0; c < 3; ++c) {
    Rgb unit{};
    unit[c] = 1;
    columns[c] = rgb_from_xyz(xyz_from_rgb(unit, ColourSpace::AcesCg), ColourSpace::Rec709);
  }
  for (std::size_t k = 0; k + 2 < image.pixels.size(); k += 3) {
    const std::array<float, 3> from = {image.pixels[k], image.pixels[k + 1], image.pixels[k + 2]};
    for (std::size_t c = 0; c < 3; ++c)
      image.pixels[k + c] = static_cast<float>(columns[0][c]) * from[0] + static_cast<float>(columns[1][c]) * from[1] +
                            static_cast<float>(columns[2][c]) * from[2];
  }
  return image;
}

}  // namespace

std::vector<std::uint32_t> displayed(const Image& rgb, double stops, ViewTransform transform) {
  static const CodeTable rolled = code_table(true), clipped = code_table(false);
  const CodeTable& table = transform == ViewTransform::Preview ? rolled : clipped;
  const auto gain = static_cast<float>(std::exp2(stops));
  std::vector<std::uint32_t> codes(static_cast<std::size_t>(rgb.width) * static_cast<std::size_t>(rgb.height));
  const float* p = rgb.pixels.data();
  for (std::uint32_t& code : codes) {
    const float r = gain * p[0], g = gain * p[1], b = gain * p[2];
    code = transform == ViewTransform::FalseColour ? false_colour(0.2126F * r + 0.7152F * g + 0.0722F * b)
                                                   : packed(code_of(table, r), code_of(table, g), code_of(table, b));
    p += 3;
  }
  return codes;
}

Result<std::vector<std::uint32_t>> ViewPainter::by_colour_view(const Image& image, ColourSpace space, double stops,
                                                               const ColourViewName& name) {
  if (!baked_ || name != baked_name_ || space != baked_space_) {
    auto view = ColourView::open(colour_config({}), name);
    if (!view) return tl::unexpected(view.error());
    auto baked = BakedView::bake(std::move(*view), space);
    if (!baked) return tl::unexpected(baked.error());
    baked_ = std::move(*baked);
    baked_name_ = name;
    baked_space_ = space;
  }
  std::vector<std::uint32_t> codes(image.pixels.size() / 3);
  if (auto ok = baked_->codes(image.pixels, static_cast<float>(std::exp2(stops)), codes); !ok)
    return tl::unexpected(ok.error());
  return codes;
}

ViewPainter::Codes ViewPainter::codes(const Image& image, ColourSpace space, double stops, ViewTransform transform,
                                      const ColourViewName& colour) {
  Codes codes;
  if (transform == ViewTransform::Colour) {
    auto shown = by_colour_view(image, space, stops, colour);
    if (shown) return {std::move(*shown), {}};
    codes.error = shown.error().to_string();
    transform = ViewTransform::Preview;
  }
  codes.rgba =
      space == ColourSpace::Rec709 ? displayed(image, stops, transform) : displayed(in_rec709(image), stops, transform);
  return codes;
}

}  // namespace contrejour::studio
