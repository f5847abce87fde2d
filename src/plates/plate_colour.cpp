// SPDX-License-Identifier: Apache-2.0
#include "plates/plate_colour.h"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <utility>

#include "base/scalar.h"
#include "image/picture_header.h"
#include "image/samples.h"
#include "plates/colour_module.h"

namespace contrejour::inline internal {
namespace {

bool has_integers(const Picture& picture) {
  const SampleType type = picture.channels[static_cast<std::size_t>(picture.rgb_source[0])].type;
  return type == SampleType::UInt8 || type == SampleType::UInt16;
}

// Alpha that colours are multiplied by in memory, but not as codes.
std::vector<float> code_alpha(const Picture& picture) {
  return has_integers(picture) ? alpha_of(picture) : std::vector<float>{};
}

// The codes 0..1 of integers, which the reader has taken for sRGB; floats are codes themselves.
Pixels codes_of(const Picture& picture) {
  Pixels codes = picture.rgb.pixels;
  if (!has_integers(picture)) return codes;
  const std::vector<float> alpha = alpha_of(picture);
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const float a = alpha.empty() ? 1.0F : alpha[i / 3];
    codes[i] = srgb_encode(a > 0.0F ? codes[i] / a : 0.0F);
  }
  return codes;
}

// own: the working space of colours that go to another space.
Result<ColourConversion> convert(Pixels& rgb, const ColourRequest& request, std::optional<ColourSpace> own = {}) {
  const auto module = colour_module();
  if (!module) return tl::unexpected(module.error());
  auto conversion = (*module)->open(request);
  if (!conversion) return conversion;
  if (own) change_primaries(rgb, *own, conversion->working);
  if (auto ok = (*module)->apply(*conversion, rgb.data(), rgb.size() / 3); !ok) return tl::unexpected(ok.error());
  return conversion;
}

}  // namespace

Result<void> to_working_space(Picture& picture, const PlateColour& colour, PlateSource& source) {
  Pixels rgb = codes_of(picture);
  const auto conversion = convert(rgb, {colour_config(colour), colour.input_space, true});
  if (!conversion) return tl::unexpected(conversion.error());
  const std::vector<float> alpha = code_alpha(picture);
  for (std::size_t i = 0; i < rgb.size() && !alpha.empty(); ++i) rgb[i] *= alpha[i / 3];
  source.space = colour.input_space;
  source.as_read = picture.rgb;
  source.header = picture.header;
  picture.rgb.pixels = std::move(rgb);
  source.as_converted = picture.rgb;
  set_colour_space(picture, conversion->working);
  return {};
}

Result<Picture> in_space(const Picture& picture, const PlateSource* source, const std::string& space,
                         const std::string& config, bool is_integer) {
  Picture coded = picture;
  const std::vector<float> alpha = code_alpha(picture);
  Pixels& rgb = coded.rgb.pixels;
  for (std::size_t i = 0; i < rgb.size() && !alpha.empty(); ++i)
    rgb[i] = alpha[i / 3] > 0.0F ? rgb[i] / alpha[i / 3] : 0.0F;
  const auto conversion = convert(rgb, {config, space, false}, colour_space_of(picture).value_or(ColourSpace::Rec709));
  if (!conversion) return tl::unexpected(conversion.error());
  if (is_integer)
    for (float& value : rgb) value = srgb_decode(static_cast<double>(std::clamp(value, 0.0F, 1.0F)));
  for (std::size_t i = 0; i < rgb.size() && !alpha.empty(); ++i) rgb[i] *= alpha[i / 3];
  const bool is_same = source != nullptr && source->space == space && has_integers(picture) == is_integer;
  for (std::size_t i = 0; is_same && i < rgb.size(); i += 3) {
    const float *now = picture.rgb.pixels.data() + i, *then = source->as_converted.pixels.data() + i;
    if (same_bits(now[0], then[0]) && same_bits(now[1], then[1]) && same_bits(now[2], then[2]))
      for (std::size_t c = 0; c < 3; ++c) rgb[i + c] = source->as_read.pixels[i + c];
  }
  if (is_same) {
    coded.header = source->header;
  } else if (coded.header != nullptr) {  // its primaries are those of the working space
    auto header = std::make_shared<PictureHeader>(*coded.header);
    header->header = without_attribute(header->header, "chromaticities");
    coded.header = std::move(header);
  }
  return coded;
}

}  // namespace contrejour::inline internal

namespace contrejour {

std::string colour_config(const PlateColour& colour) {
  if (!colour.config.empty()) return colour.config;
  const char* const set = std::getenv("OCIO");
  return set == nullptr ? std::string() : std::string(set);
}

}  // namespace contrejour
