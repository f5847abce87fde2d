// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/apply_files.h"

#include <cmath>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "base/lower_extension.h"
#include "contrejour/expert/detected_picture.h"
#include "contrejour/expert/preview_exposure.h"

namespace contrejour {
namespace {

using params::Values;

bool has_exposure(const OutputFile& file, const Values& values) {
  return lower_extension(file.destination()) == ".png" && values.text("exposure");
}

Picture exposed(Picture picture, double stops) {
  const auto gain = static_cast<float>(std::exp2(stops));
  for (float& value : picture.rgb.pixels) value *= gain;
  return picture;
}

Result<void> copy_bytes(OutputFile& file, const std::filesystem::path& input_path) {
  constexpr std::size_t kBlockBytes = std::size_t{1} << 20;
  std::ifstream input(input_path, std::ios::binary);
  std::vector<char> block(kBlockBytes);
  while (input) {
    input.read(block.data(), static_cast<std::streamsize>(block.size()));
    const std::string_view part(block.data(), static_cast<std::size_t>(input.gcount()));
    if (auto ok = file.write(part); !ok) return ok;
  }
  if (input.bad() || !input.eof())
    return failure(ErrorCode::Io, "the picture cannot be read again to copy it; check that the file is unchanged",
                   {input_path.string()});
  return {};
}

}  // namespace

Result<void> write_photograph(OutputFile& file, const Picture& picture, const Values& values, const Context& context) {
  if (!has_exposure(file, values)) return write_picture(file, picture, context);
  const PreviewSettings settings = preview_settings(values, picture.rgb, params::DefaultExposure::None);
  return write_picture(file, exposed(picture, settings.exposure_stops), context);
}

Result<void> copy_photograph(OutputFile& file, const std::filesystem::path& input, const Picture& picture,
                             const Values& values, const Context& context) {
  const char* const format = picture.header != nullptr ? ".exr" : ".png";
  std::error_code error;
  const bool as_read = picture.exr_compression == ExrCompression::AsRead;
  if (!as_read || has_exposure(file, values) || lower_extension(file.destination()) != format ||
      !std::filesystem::is_regular_file(input, error))
    return write_photograph(file, picture, values, context);
  return copy_bytes(file, input);
}

Picture aligned_picture(const Image& image, const Picture& picture, const FlarePlan& plan) {
  Picture alone = picture_of(image);
  alone.data_window = picture.data_window;
  alone.display_window = picture.display_window;
  set_colour_space(alone, plan.space);
  set_pixel_aspect(alone, plan.pixel_aspect);
  return alone;
}

Result<void> write_aligned(OutputFile& file, const Image& image, const Picture& picture, const FlarePlan& plan,
                           const Context& context) {
  return write_picture(file, aligned_picture(image, picture, plan), context);
}

Result<void> write_detected(OutputFile& file, const Picture& picture, const FlarePlan& plan, const Context& context) {
  if (lower_extension(file.destination()) == ".exr")
    return write_aligned(file, pixels_of_lights(picture.rgb, plan.found), picture, plan, context);
  return write_preview_png(file, false_colour_lights(picture.rgb, plan.found, plan.space), {}, context);
}

}  // namespace contrejour
