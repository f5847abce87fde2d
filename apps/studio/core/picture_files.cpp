// SPDX-License-Identifier: Apache-2.0
#include "studio/core/picture_files.h"

#include <utility>

#include <fmt/format.h>

#include "contrejour/apply.h"
#include "contrejour/expert/apply_files.h"
#include "contrejour/expert/preview_exposure.h"
#include "contrejour/expert/requests.h"
#include "contrejour/expert/settings.h"
#include "contrejour/image_io.h"

namespace contrejour::studio {
namespace {

std::string extension_of(const std::filesystem::path& file) { return file.extension().string(); }

Result<DrawnPicture> draw_on_plate(const PictureInput& input, Renderer& renderer, const Context& context) {
  const Picture& picture = input.plate->picture;
  const auto plan = plan_flare(picture, *input.lens, input.values);
  if (!plan) return tl::unexpected(plan.error());
  auto flare = render_flare(*plan, picture.rgb, input.values, renderer, context);
  if (!flare) return tl::unexpected(flare.error());
  return DrawnPicture{input, std::move(flare->image), !plan->lights.empty()};
}

Result<void> write_on_plate(OutputFile& file, const DrawnPicture& drawn, const Context& context) {
  const Plate& plate = *drawn.input.plate;
  Picture picture = plate.picture;
  add_flare(picture.rgb, drawn.flare);
  const std::string extension = extension_of(file.destination());
  const bool is_usual = plate.source == nullptr && (extension == ".exr" || extension == ".png");
  const PlateColour colour{drawn.input.reference.input_space, "", drawn.input.reference.config};
  if (!is_usual) return write_plate(file, picture, plate.source, colour, context);
  return drawn.has_lights ? write_photograph(file, picture, drawn.input.values, context)
                          : copy_photograph(file, drawn.input.reference.file, picture, drawn.input.values, context);
}

}  // namespace

Result<DrawnPicture> draw_picture(const PictureInput& input, Renderer& renderer, const Context& context) {
  if (input.plate) return draw_on_plate(input, renderer, context);
  const auto request = picture_request(input.values, *input.lens, {}, input.without);
  if (!request) return tl::unexpected(request.error());
  auto flare = render_picture(*request, renderer, context);
  if (!flare) return tl::unexpected(flare.error());
  return DrawnPicture{input, std::move(flare->image), true};
}

Image picture_of(const DrawnPicture& drawn) {
  if (!drawn.input.plate) return drawn.flare;
  Image picture = drawn.input.plate->picture.rgb;
  add_flare(picture, drawn.flare);
  return picture;
}

Result<void> write_drawn(OutputFile& file, const DrawnPicture& drawn, const Context& context) {
  if (drawn.input.plate) return write_on_plate(file, drawn, context);
  const params::Values& values = drawn.input.values;
  if (extension_of(file.destination()) == ".png")
    return write_preview_png(
        file, drawn.flare, params::preview_settings(values, drawn.flare, params::DefaultExposure::Automatic), context);
  Picture picture = contrejour::picture_of(drawn.flare);
  set_colour_space(picture, params::colour_space(values, ColourSpace::Rec709));
  set_pixel_aspect(picture, values.real("pixel-aspect").value_or(squeeze_of(*drawn.input.lens)));
  return write_picture(file, picture, context);
}

Result<void> check_picture_name(const std::string& file, bool has_plate) {
  const std::string extension = extension_of(file);
  if (extension == ".exr" || extension == ".png" || (has_plate && is_plate_name(file))) return {};
  return failure(ErrorCode::Unsupported, "give a name that ends in .exr or .png", {file});
}

}  // namespace contrejour::studio
