// SPDX-License-Identifier: Apache-2.0
#include "studio/core/export_picture.h"

#include <filesystem>

#include "contrejour/expert/preview_exposure.h"
#include "contrejour/expert/requests.h"
#include "contrejour/expert/source_renderer.h"
#include "contrejour/image_io.h"

namespace contrejour::studio {

Result<void> export_picture(const params::Values& values, const LensState& lens, const std::string& file,
                            const Context& context) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension != ".exr" && extension != ".png")
    return failure(ErrorCode::Unsupported, "give a name that ends in .exr or .png", {file});
  const auto request = picture_request(values, lens);
  if (!request) return tl::unexpected(request.error());
  auto renderer = renderer_of(values, FlareSource(lens));
  if (!renderer) return tl::unexpected(renderer.error());
  const auto flare = render_picture(*request, *renderer, context);
  if (!flare) return tl::unexpected(flare.error());
  if (extension == ".png") {
    const auto preview = params::preview_settings(values, flare->image, params::DefaultExposure::Automatic);
    return write_preview_png(std::filesystem::path(file), flare->image, preview, context);
  }
  Picture picture = picture_of(flare->image);
  set_colour_space(picture, request->settings.colour_space);
  set_pixel_aspect(picture, request->pixel_aspect);
  return write_picture(std::filesystem::path(file), picture, context);
}

}  // namespace contrejour::studio
