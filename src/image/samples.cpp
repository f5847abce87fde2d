// SPDX-License-Identifier: Apache-2.0
#include "image/samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include <half.h>

#include "base/scalar.h"

namespace contrejour::inline internal {
namespace {

constexpr float kLargestHalf = 65504;

template <class T>
T load(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

template <class T>
void store(T value, std::byte* to) {
  std::memcpy(to, &value, sizeof value);
}

float half_to_float(std::uint16_t bits) {
  half value;
  value.setBits(bits);
  return static_cast<float>(value);
}

std::uint16_t float_to_half(float value) {
  if (std::isfinite(value)) value = std::clamp(value, -kLargestHalf, kLargestHalf);
  return half(value).bits();
}

// The decoded value of every code; 65536 floats at most, made once.
template <class Code>
const std::vector<float>& srgb_table() {
  static const std::vector<float> table = [] {
    constexpr std::size_t count = std::size_t{std::numeric_limits<Code>::max()} + 1;
    std::vector<float> values(count);
    for (std::size_t i = 0; i < count; ++i) values[i] = srgb_decode(static_cast<double>(i) / (count - 1));
    return values;
  }();
  return table;
}

template <class Code>
float decode_integer(Code code, Coding coding) {
  if (coding == Coding::Colour) return srgb_table<Code>()[code];
  return static_cast<float>(code) / static_cast<float>(std::numeric_limits<Code>::max());
}

template <class Code>
Code encode_integer(float value, Coding coding) {
  const float coded = coding == Coding::Colour ? srgb_encode(value) : (value > 0 ? std::min(value, 1.0F) : 0.0F);
  return static_cast<Code>(std::lround(coded * static_cast<float>(std::numeric_limits<Code>::max())));
}

std::uint32_t encode_uint32(float value) {
  if (!(value > 0)) return 0;
  const double rounded = std::nearbyint(static_cast<double>(value));
  return static_cast<std::uint32_t>(std::min(rounded, 4294967295.0));
}

float decode_sample(SampleType type, Coding coding, const std::byte* from) {
  switch (type) {
    case SampleType::Half: return half_to_float(load<std::uint16_t>(from));
    case SampleType::Float: return load<float>(from);
    case SampleType::UInt32: return static_cast<float>(load<std::uint32_t>(from));
    case SampleType::UInt8: return decode_integer(load<std::uint8_t>(from), coding);
    case SampleType::UInt16: return decode_integer(load<std::uint16_t>(from), coding);
  }
  return 0;
}

bool is_png(SampleType type) { return type == SampleType::UInt8 || type == SampleType::UInt16; }

// A grey picture stays grey: coloured pixels are written as luminance.
Rgb grey_weights(const Picture& picture) {
  const ColourSpace space = colour_space_of(picture).value_or(ColourSpace::Rec709);
  return {luminance({1, 0, 0}, space), luminance({0, 1, 0}, space), luminance({0, 0, 1}, space)};
}

// The value of channel component `c` (3: grey) at a pixel.
float rgb_value(const Picture& picture, int c, std::size_t pixel, const Rgb& grey_weights) {
  const float* const p = picture.rgb.pixels.data() + 3 * pixel;
  if (c < 3) return p[c];
  if (same_bits(p[0], p[1]) && same_bits(p[1], p[2])) return p[0];
  return static_cast<float>(grey_weights[0] * p[0] + grey_weights[1] * p[1] + grey_weights[2] * p[2]);
}

}  // namespace

bool is_alpha(const PictureChannel& channel) {
  return channel.name == "A" && channel.x_sampling == 1 && channel.y_sampling == 1;
}

float srgb_decode(double coded) {
  return static_cast<float>(coded <= 0.04045 ? coded / 12.92 : std::pow((coded + 0.055) / 1.055, 2.4));
}

float srgb_encode(float linear) {
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 1;
  return linear <= 0.0031308F ? 12.92F * linear : 1.055F * std::pow(linear, 1 / 2.4F) - 0.055F;
}

}  // namespace contrejour::inline internal

namespace contrejour {

std::size_t size_of(SampleType type) {
  switch (type) {
    case SampleType::Half:
    case SampleType::UInt16: return 2;
    case SampleType::UInt8: return 1;
    case SampleType::Float:
    case SampleType::UInt32: break;
  }
  return 4;
}

}  // namespace contrejour

namespace contrejour::inline internal {

std::vector<float> decode_samples(const PictureChannel& channel, Coding coding) {
  const std::size_t size = size_of(channel.type);
  std::vector<float> values(channel.samples.size() / size);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = decode_sample(channel.type, coding, channel.samples.data() + i * size);
  return values;
}

void encode_sample(SampleType type, Coding coding, float value, std::byte* out) {
  switch (type) {
    case SampleType::Half: return store(float_to_half(value), out);
    case SampleType::Float: return store(value, out);
    case SampleType::UInt32: return store(encode_uint32(value), out);
    case SampleType::UInt8: return store(encode_integer<std::uint8_t>(value, coding), out);
    case SampleType::UInt16: return store(encode_integer<std::uint16_t>(value, coding), out);
  }
}

std::size_t sample_count(const PixelWindow& window, int x_sampling, int y_sampling) {
  const auto along = [](int pixels, int sampling) {
    return (static_cast<std::size_t>(pixels) + static_cast<std::size_t>(sampling) - 1) /
           static_cast<std::size_t>(sampling);
  };
  return along(window.width, x_sampling) * along(window.height, y_sampling);
}

int rgb_component(const Picture& picture, std::size_t k) {
  const auto& source = picture.rgb_source;
  const int index = static_cast<int>(k);
  if (source[0] == index && source[1] == index && source[2] == index) return 3;
  for (int c = 0; c < 3; ++c)
    if (source[static_cast<std::size_t>(c)] == index) return c;
  return -1;
}

std::vector<float> alpha_of(const Picture& picture) {
  for (const PictureChannel& channel : picture.channels)
    if (is_alpha(channel)) return decode_samples(channel, Coding::Linear);
  return {};
}

namespace {

// The alpha to write to a PNG, which rgb is multiplied by: at least the brightest colour, so that light that was added
// where a picture is transparent is kept, and looks right over black. It is rounded up to the type's steps.
std::vector<float> alpha_to_write(const Picture& picture, SampleType type) {
  std::vector<float> alpha = alpha_of(picture);
  const float steps = type == SampleType::UInt8 ? 255.0F : 65535.0F;
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    float brightest = 0.0F;
    for (std::size_t c = 0; c < 3; ++c) brightest = std::max(brightest, picture.rgb.pixels[3 * i + c]);
    if (brightest > alpha[i]) alpha[i] = std::min(std::ceil(brightest * steps) / steps, 1.0F);
  }
  return alpha;
}

}  // namespace

std::vector<std::byte> samples_to_write(const Picture& picture, std::size_t k, SampleType type) {
  const PictureChannel& channel = picture.channels[k];
  const int component = rgb_component(picture, k);
  const bool is_png_alpha = component < 0 && is_png(type) && is_alpha(channel);
  if (component < 0 && type == channel.type && !is_png_alpha) return channel.samples;
  const std::size_t size = size_of(type);
  if (component < 0) {
    const std::vector<float> values =
        is_png_alpha ? alpha_to_write(picture, type) : decode_samples(channel, Coding::Linear);
    std::vector<std::byte> out(values.size() * size);
    for (std::size_t i = 0; i < values.size(); ++i)
      encode_sample(type, Coding::Linear, values[i], out.data() + i * size);
    return out;
  }

  const std::size_t count = sample_count(picture.data_window, 1, 1);
  const std::vector<float> read = type == channel.type ? decode_samples(channel, Coding::Colour) : std::vector<float>{};
  const bool has_bits = read.size() == count;  // a new picture has none
  const std::vector<float> alpha_read = is_png(channel.type) ? alpha_of(picture) : std::vector<float>{};
  const std::vector<float> alpha = is_png(type) ? alpha_to_write(picture, type) : std::vector<float>{};
  const Rgb grey = grey_weights(picture);
  std::vector<std::byte> out(count * size);
  for (std::size_t i = 0; i < count; ++i) {
    const float a = alpha.empty() ? 1 : alpha[i];
    const float value = rgb_value(picture, component, i, grey);
    if (has_bits && same_bits(value, alpha_read.empty() ? read[i] : read[i] * alpha_read[i]) &&
        (alpha_read.empty() || alpha_read[i] == a)) {
      std::memcpy(out.data() + i * size, channel.samples.data() + i * size, size);
    } else {
      const float coded = !is_png(type) ? value : (a > 0 ? value / a : 0);
      encode_sample(type, Coding::Colour, coded, out.data() + i * size);
    }
  }
  return out;
}

}  // namespace contrejour::inline internal
