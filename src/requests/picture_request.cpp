// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "contrejour/expert/flare_source.h"
#include "contrejour/expert/measured_settings.h"
#include "contrejour/expert/requests.h"
#include "contrejour/expert/settings.h"

namespace contrejour {
namespace {

// A caller's lights come first, and the values' own follow them.
Result<std::vector<Light>> lights_of_request(const params::Values& values, const LensState& lens, const Frame& frame,
                                             ColourSpace space, std::span<const Light> lights, WithoutLights without) {
  if (lights.empty() && without == WithoutLights::DefaultLight) return params::lights(values, lens, frame, space);
  auto given = params::given_lights(values, lens, frame, space);
  if (!given) return given;
  given->insert(given->begin(), lights.begin(), lights.end());
  return given;
}

}  // namespace

Result<PictureRequest> picture_request(const params::Values& values, const LensState& lens,
                                       std::span<const Light> lights, WithoutLights without) {
  const auto size = params::parse_size(*values.text("size"));
  if (!size) return tl::unexpected(size.error());
  const PixelWindow window{0, 0, size->width, size->height};
  PictureRequest request;
  request.pixel_aspect = values.real("pixel-aspect").value_or(squeeze_of(lens));
  auto grid = pixel_grid(values, lens, window, window, request.pixel_aspect);
  if (!grid) return tl::unexpected(grid.error());
  request.grid = *grid;
  const ColourSpace space = params::colour_space(values, ColourSpace::Rec709);
  auto all_lights = lights_of_request(values, lens, request.grid.frame, space, lights, without);
  if (!all_lights) return tl::unexpected(all_lights.error());
  request.lights = std::move(*all_lights);
  request.settings = params::frame_settings(values, request.grid.frame, space);
  return request;
}

Result<PictureRequest> picture_request(const params::Values& values, const MeasuredFlare& flare,
                                       std::span<const Light> lights, WithoutLights without) {
  if (auto good = check_measured_values(flare, values, MeasuredUse::Lights); !good) return tl::unexpected(good.error());
  auto request = picture_request(values, ideal_lens_of(flare), lights, without);
  if (!request) return request;
  auto exposed = exposed_lights(flare, std::move(request->lights), values);
  if (!exposed) return tl::unexpected(exposed.error());
  request->lights = std::move(*exposed);
  request->warnings = range_warnings(flare, request->lights);
  return request;
}

Result<Flare> render_picture(const PictureRequest& request, Renderer& renderer, const Context& context) {
  auto flare = renderer.render(request.lights, request.settings, context);
  if (!flare) return flare;
  auto picture = picture_of_flare(std::move(flare->image), request.grid);
  if (!picture) return tl::unexpected(picture.error());
  flare->image = std::move(*picture);
  return flare;
}

Result<RenderStatistics> render_picture(const PictureRequest& request, Renderer& renderer, const ImageView& pixels,
                                        const Context& context) {
  if (const auto fits = check_view(pixels, request.grid.width, request.grid.height); !fits)
    return tl::unexpected(fits.error());
  if (request.grid.is_square())
    return renderer.render(request.lights, request.settings, FrameTarget{.pixels = pixels}, context);
  auto flare = render_picture(request, renderer, context);
  if (!flare) return tl::unexpected(flare.error());
  if (const auto written = write_pixels(flare->image, pixels, context); !written)
    return tl::unexpected(written.error());
  return std::move(flare->statistics);
}

}  // namespace contrejour
