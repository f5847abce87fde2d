// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/station_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "contrejour/image_io.h"

namespace contrejour {
namespace {

constexpr const char* kAngleAttribute = "headAngleDegrees";
constexpr const char* kDirectAttribute = "directImage";  // x, y, red, green, blue
constexpr const char* kMosaicAttribute = "bayerPattern";
constexpr std::array<std::string_view, 4> kPatternNames{"rggb", "bggr", "grbg", "gbrg"};

void add_station_layer(Picture& picture, const std::string& layer, const Image& image) {
  for (std::size_t c = 0; c < 3; ++c) {
    PictureChannel channel;
    channel.name = layer + "." + "RGB"[c];
    channel.type = SampleType::Float;
    channel.samples.resize(image.pixels.size() / 3 * sizeof(float));
    for (std::size_t k = 0; k < image.pixels.size() / 3; ++k)
      std::memcpy(channel.samples.data() + k * sizeof(float), &image.pixels[3 * k + c], sizeof(float));
    picture.channels.push_back(std::move(channel));
  }
}

Result<Image> station_layer(const Picture& picture, const std::string& layer, const std::filesystem::path& file) {
  Image image(picture.rgb.width, picture.rgb.height);
  for (std::size_t c = 0; c < 3; ++c) {
    const std::string name = layer + "." + "RGB"[c];
    const auto channel = std::ranges::find(picture.channels, name, &PictureChannel::name);
    if (channel == picture.channels.end() || channel->type != SampleType::Float ||
        channel->samples.size() != image.pixels.size() / 3 * sizeof(float)) {
      return failure(ErrorCode::Parse,
                     fmt::format("there is no {}; merge the station again with `contrejour measure merge`", name),
                     {file.string(), 0, 0});
    }
    for (std::size_t k = 0; k < image.pixels.size() / 3; ++k)
      std::memcpy(&image.pixels[3 * k + c], channel->samples.data() + k * sizeof(float), sizeof(float));
  }
  return image;
}

// Finite numbers between commas; none of a text that is anything else.
std::vector<double> station_numbers(std::string_view text) {
  std::vector<double> numbers;
  for (const char* at = text.data(); at <= text.data() + text.size();) {
    double value = 0;
    const auto [end, error] = std::from_chars(at, text.data() + text.size(), value);
    const bool ends_well = end == text.data() + text.size() || *end == ',';
    if (error != std::errc() || !ends_well || !std::isfinite(value)) return {};
    numbers.push_back(value);
    at = end + 1;
  }
  return numbers;
}

}  // namespace

Result<void> write_station(const std::filesystem::path& file, const MergedStation& station) {
  Picture picture = picture_of(station.image.rate);
  add_station_layer(picture, "variance", station.image.variance);
  add_station_layer(picture, "valid", station.image.valid);
  set_text_attribute(picture, kAngleAttribute, fmt::format("{}", station.angle_deg));
  if (const auto& direct = station.direct) {
    set_text_attribute(picture, kDirectAttribute,
                       fmt::format("{},{},{},{},{}", direct->position_px.x, direct->position_px.y, direct->rate[0],
                                   direct->rate[1], direct->rate[2]));
  }
  if (station.image.pattern)
    set_text_attribute(picture, kMosaicAttribute,
                       std::string(kPatternNames[static_cast<std::size_t>(*station.image.pattern)]));
  return write_picture(file, picture);
}

Result<CapturedImage> read_station(const std::filesystem::path& file) {
  auto picture = read_picture(file);
  if (!picture) return tl::unexpected(picture.error());
  auto variance = station_layer(*picture, "variance", file), valid = station_layer(*picture, "valid", file);
  if (!variance) return tl::unexpected(variance.error());
  if (!valid) return tl::unexpected(valid.error());
  CapturedImage image{std::move(picture->rgb), std::move(*variance), std::move(*valid), {}};
  const auto name = std::ranges::find(kPatternNames, text_attribute(*picture, kMosaicAttribute).value_or(""));
  if (name != kPatternNames.end()) image.pattern = static_cast<BayerPattern>(name - kPatternNames.begin());
  return image;
}

Result<StationFacts> read_station_facts(const std::filesystem::path& file) {
  const auto picture = read_picture(file);
  if (!picture) return tl::unexpected(picture.error());
  const auto angle = text_attribute(*picture, kAngleAttribute);
  const auto angle_deg = station_numbers(angle.value_or(""));
  if (angle_deg.size() != 1)
    return failure(ErrorCode::Parse, "this is not a merged station; remove it or name another folder",
                   {file.string(), 0, 0});
  StationFacts facts{angle_deg[0], picture->rgb.width, picture->rgb.height, {}};
  const auto direct = station_numbers(text_attribute(*picture, kDirectAttribute).value_or(""));
  if (direct.size() == 5) facts.direct = DirectFlux{{direct[0], direct[1]}, {direct[2], direct[3], direct[4]}};
  return facts;
}

}  // namespace contrejour
