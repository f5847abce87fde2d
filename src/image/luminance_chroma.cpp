// SPDX-License-Identifier: Apache-2.0
#include "image/luminance_chroma.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfOutputFile.h>
#include <ImfRgbaFile.h>
#include <ImfRgbaYca.h>
#include <ImfStandardAttributes.h>

#include "base/scalar.h"
#include "image/exr_streams.h"
#include "image/picture_header.h"
#include "image/samples.h"

namespace contrejour::inline internal {
namespace {

constexpr std::array<const char*, 3> kLuminanceChroma = {"Y", "RY", "BY"};
constexpr int kReach = Imf::RgbaYca::N2;

std::array<const PictureChannel*, 3> channels_of(const Picture& picture) {
  const auto at = [&](int index) { return &picture.channels[static_cast<std::size_t>(index)]; };
  return {at(picture.rgb_source[0]), at(picture.chroma_source[0]), at(picture.chroma_source[1])};
}

Imf::Chromaticities chromaticities_of(const Picture& picture) {
  const Imf::Header header = header_of(picture);
  return Imf::hasChromaticities(header) ? Imf::chromaticities(header) : Imf::Chromaticities();
}

// Luminance Y, (R - Y) / Y and (B - Y) / Y; all 0 for a colour without luminance (RGBAtoYCA of ImfRgbaYca.h).
struct Yca {
  double y = 0, ry = 0, by = 0;
};

Yca yca_of(const float* rgb, const Imath::V3f& weights) {
  for (int c = 0; c < 3; ++c)
    if (!std::isfinite(rgb[c]) || rgb[c] < 0) return {};
  const double y = double{weights.x} * rgb[0] + double{weights.y} * rgb[1] + double{weights.z} * rgb[2];
  if (!(y > 0)) return {};
  return {y, (rgb[0] - y) / y, (rgb[2] - y) / y};
}

// The change of each pixel; the chroma is in r and b, where ImfRgbaYca's filters expect it.
struct Changes {
  std::vector<float> luminance;
  std::vector<Imf::Rgba> chroma;
};

Changes changes_of(const Picture& picture) {
  const Image before = rgb_of_luminance_chroma(picture);
  const Imath::V3f weights = Imf::RgbaYca::computeYw(chromaticities_of(picture));
  const std::size_t count = before.pixels.size() / 3;
  Changes changes{std::vector<float>(count), std::vector<Imf::Rgba>(count, Imf::Rgba(0, 0, 0, 0))};
  for (std::size_t i = 0; i < count; ++i) {
    const float *const from = before.pixels.data() + 3 * i, *const to = picture.rgb.pixels.data() + 3 * i;
    if (same_bits(from[0], to[0]) && same_bits(from[1], to[1]) && same_bits(from[2], to[2])) continue;
    const Yca old = yca_of(from, weights), now = yca_of(to, weights);
    changes.luminance[i] = static_cast<float>(now.y - old.y);
    changes.chroma[i].r = static_cast<float>(now.ry - old.ry);
    changes.chroma[i].b = static_cast<float>(now.by - old.by);
  }
  return changes;
}

// The filter is linear, so filtering the changes gives the changes of the filtered chroma. Rows and columns beyond the
// picture are those at its edge, as in OpenEXR's writer. Every second row has values at every second pixel.
class FilteredChroma {
 public:
  FilteredChroma(const std::vector<Imf::Rgba>& chroma, int width, int height)
      : width_(width), height_(height), rows_(chroma.size()) {
    std::vector<Imf::Rgba> padded(static_cast<std::size_t>(width) + 2 * std::size_t{kReach});
    for (int y = 0; y < height; ++y) {
      const Imf::Rgba* const row = chroma.data() + at(y);
      for (int x = -kReach; x < width + kReach; ++x) padded.data()[x + kReach] = row[std::clamp(x, 0, width - 1)];
      Imf::RgbaYca::decimateChromaHoriz(width, padded.data(), rows_.data() + at(y));
    }
  }

  void row(int y, std::vector<Imf::Rgba>& out) const {
    const Imf::Rgba* rows[Imf::RgbaYca::N];
    for (int k = 0; k < Imf::RgbaYca::N; ++k) rows[k] = rows_.data() + at(std::clamp(y + k - kReach, 0, height_ - 1));
    Imf::RgbaYca::decimateChromaVert(width_, rows, out.data());
  }

 private:
  [[nodiscard]] std::size_t at(int y) const { return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_); }

  int width_, height_;
  std::vector<Imf::Rgba> rows_;
};

// Adds `change` to sample `index`; the bits stay the same if it is 0.
void add_to_sample(const PictureChannel& channel, const std::vector<float>& read, std::size_t index, float change,
                   std::vector<std::byte>& samples) {
  if (change == 0 || !std::isfinite(change)) return;
  encode_sample(channel.type, Coding::Linear, read[index] + change, samples.data() + index * size_of(channel.type));
}

std::vector<std::byte> luminance_to_write(const PictureChannel& channel, const std::vector<float>& changes) {
  std::vector<std::byte> samples = channel.samples;
  const std::vector<float> read = decode_samples(channel, Coding::Linear);
  for (std::size_t i = 0; i < read.size(); ++i) add_to_sample(channel, read, i, changes[i], samples);
  return samples;
}

}  // namespace

bool is_luminance_chroma(const Picture& picture) { return picture.chroma_source != std::array<int, 2>{-1, -1}; }

bool has_chroma_sizes(const Picture& picture) {
  const auto [luminance, red, blue] = channels_of(picture);
  const PixelWindow& window = picture.data_window;
  const auto is_half = [](const PictureChannel& c) { return c.x_sampling == 2 && c.y_sampling == 2; };
  // OpenEXR requires windows that subsampled channels fill.
  return luminance->x_sampling == 1 && luminance->y_sampling == 1 && is_half(*red) && is_half(*blue) &&
         window.width % 2 == 0 && window.height % 2 == 0 && window.x % 2 == 0 && window.y % 2 == 0;
}

Image rgb_of_luminance_chroma(const Picture& picture) {
  const PixelWindow& window = picture.data_window;
  const Imath::Box2i box({window.x, window.y}, {window.x + window.width - 1, window.y + window.height - 1});
  Imf::Header header(box, box);
  header.compression() = Imf::NO_COMPRESSION;
  const Imf::Chromaticities chromaticities = chromaticities_of(picture);
  // Throws where they give no weights of luminance. RgbaInputFile would throw, too, and leak its file.
  static_cast<void>(Imf::RgbaYca::computeYw(chromaticities));
  Imf::addChromaticities(header, chromaticities);
  Imf::FrameBuffer frame_buffer;
  const auto channels = channels_of(picture);
  std::array<std::vector<std::byte>, 3> halves;
  for (std::size_t k = 0; k < channels.size(); ++k) {
    const PictureChannel& channel = *channels[k];
    halves[k] = channel.samples;
    if (channel.type != SampleType::Half) {
      const std::vector<float> values = decode_samples(channel, Coding::Linear);
      halves[k].resize(2 * values.size());
      for (std::size_t i = 0; i < values.size(); ++i)
        encode_sample(SampleType::Half, Coding::Linear, values[i], halves[k].data() + 2 * i);
    }
    header.channels().insert(kLuminanceChroma[k], Imf::Channel(Imf::HALF, channel.x_sampling, channel.y_sampling));
    frame_buffer.insert(kLuminanceChroma[k], Imf::Slice::Make(Imf::HALF, halves[k].data(), box, 0, 0,
                                                              channel.x_sampling, channel.y_sampling));
  }
  // OpenEXR converts chroma to colours only while reading a file, so a file is made in memory.
  std::vector<std::byte> bytes;
  {
    MemoryOutput stream(bytes);
    Imf::OutputFile out(stream, header);
    out.setFrameBuffer(frame_buffer);
    out.writePixels(window.height);
  }
  MemoryInput stream(bytes, "luminance and chroma");
  Imf::RgbaInputFile in(stream);
  Image rgb(window.width, window.height, 3);
  std::vector<Imf::Rgba> row(static_cast<std::size_t>(window.width));
  for (int y = 0; y < window.height; ++y) {
    in.setFrameBuffer(row.data() - window.x, 1, 0);
    in.readPixels(window.y + y);
    for (int x = 0; x < window.width; ++x) {
      const Imf::Rgba& pixel = row[static_cast<std::size_t>(x)];
      rgb.at(x, y, 0) = pixel.r;
      rgb.at(x, y, 1) = pixel.g;
      rgb.at(x, y, 2) = pixel.b;
    }
  }
  return rgb;
}

std::array<std::vector<std::byte>, 3> luminance_chroma_to_write(const Picture& picture) {
  const Changes changes = changes_of(picture);
  const auto [luminance, red, blue] = channels_of(picture);
  const int width = picture.data_window.width, height = picture.data_window.height;
  std::array<std::vector<std::byte>, 3> samples = {luminance_to_write(*luminance, changes.luminance), red->samples,
                                                   blue->samples};
  const std::vector<float> red_read = decode_samples(*red, Coding::Linear);
  const std::vector<float> blue_read = decode_samples(*blue, Coding::Linear);
  const FilteredChroma filtered(changes.chroma, width, height);
  std::vector<Imf::Rgba> row(static_cast<std::size_t>(width));
  for (int y = 0; y < height; y += 2) {
    filtered.row(y, row);
    for (int x = 0; x < width; x += 2) {
      const std::size_t at =
          static_cast<std::size_t>(y / 2) * static_cast<std::size_t>(width / 2) + static_cast<std::size_t>(x / 2);
      add_to_sample(*red, red_read, at, row[static_cast<std::size_t>(x)].r, samples[1]);
      add_to_sample(*blue, blue_read, at, row[static_cast<std::size_t>(x)].b, samples[2]);
    }
  }
  return samples;
}

Picture with_rgb_channels(const Picture& picture) {
  Picture changed = picture;
  changed.channels.clear();
  for (const char* name : {"R", "G", "B"}) changed.channels.push_back({name, SampleType::Half, 1, 1, false, {}});
  changed.rgb_source = {0, 1, 2};
  changed.chroma_source = {-1, -1};
  for (const PictureChannel& channel : picture.channels)
    if (is_alpha(channel)) changed.channels.push_back(channel);
  return changed;
}

}  // namespace contrejour::inline internal
