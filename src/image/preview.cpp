// SPDX-License-Identifier: Apache-2.0
// Converts scene-linear images to display images.
#include <cmath>

#include "image/formats.h"
#include "image/png_file.h"
#include "image/samples.h"

namespace contrejour {
namespace {

constexpr float kRollOffStart = 0.8F;

// Linear up to the knee, from there with a continuous slope towards 1.
float roll_off(float value) {
  if (!(value > kRollOffStart)) return value;
  constexpr float headroom = 1 - kRollOffStart;
  return 1 - headroom * std::exp((kRollOffStart - value) / headroom);
}

Result<void> write_preview(const PngSink& sink, const SourcePosition& position, const Image& rgb,
                           const PreviewSettings& settings, const Context& context) {
  const bool complete =
      rgb.width > 0 && rgb.height > 0 && rgb.channels > 0 && rgb.pixels.size() == rgb.index(0, rgb.height);
  if (!complete) return failure(ErrorCode::InvalidArgument, "the image is empty", position);
  const float gain = static_cast<float>(std::exp2(settings.exposure_stops));
  const int channels = rgb.channels < 3 ? 1 : 3;
  const auto fill = [&](int y, std::byte* row) {
    for (int x = 0; x < rgb.width; ++x)
      for (int c = 0; c < channels; ++c) {
        const float value = gain * rgb.at(x, y, c);
        const float shown = settings.roll_off_highlights ? roll_off(value) : value;
        encode_sample(SampleType::UInt8, Coding::Colour, shown, row++);
      }
  };
  try {
    return write_png(sink, position, {rgb.width, rgb.height, channels, 8}, fill, context);
  } catch (const std::exception& e) {
    return failure(ErrorCode::Io, std::string("cannot write: ") + e.what(), position);
  }
}

}  // namespace

Result<void> write_preview_png(const std::filesystem::path& file, const Image& rgb, const PreviewSettings& settings,
                               const Context& context) {
  return write_whole(file, [&](OutputFile& out) { return write_preview_png(out, rgb, settings, context); });
}

Result<void> write_preview_png(OutputFile& file, const Image& rgb, const PreviewSettings& settings,
                               const Context& context) {
  return write_preview([&file](std::span<const std::byte> bytes) { return file.write(bytes); },
                       {file.destination().string()}, rgb, settings, context);
}

Result<std::vector<std::byte>> preview_png(const Image& rgb, const PreviewSettings& settings, const Context& context) {
  std::vector<std::byte> png;
  const auto append = [&png](std::span<const std::byte> bytes) -> Result<void> {
    png.insert(png.end(), bytes.begin(), bytes.end());
    return {};
  };
  if (auto ok = write_preview(append, {}, rgb, settings, context); !ok) return tl::unexpected(ok.error());
  return png;
}

}  // namespace contrejour
