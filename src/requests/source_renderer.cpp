// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/source_renderer.h"

#include <utility>

#include "contrejour/expert/measured_settings.h"
#include "contrejour/expert/renderer_settings.h"

namespace contrejour {
namespace {

void add_range_warnings(FlarePlan& plan, const MeasuredFlare& flare) {
  for (std::string& warning : range_warnings(flare, plan.lights)) plan.warnings.push_back(std::move(warning));
}

}  // namespace

Result<SourceRenderer> renderer_of(const params::Values& values, const FlareSource& source) {
  if (const auto* flare = std::get_if<MeasuredFlare>(&source)) return SourceRenderer(*flare);
  auto renderer = Renderer::create();
  if (!renderer) return tl::unexpected(renderer.error());
  if (auto set = configure_renderer(*renderer, values); !set) return tl::unexpected(set.error());
  if (auto set = renderer->set_lens(std::get<LensState>(source)); !set) return tl::unexpected(set.error());
  return SourceRenderer(std::move(*renderer));
}

Result<SourceRenderer> another(const SourceRenderer& renderer) {
  const auto* of_lens = std::get_if<Renderer>(&renderer);
  if (of_lens == nullptr) return SourceRenderer(std::get<MeasuredFlare>(renderer));
  auto other = of_lens->another();
  if (!other) return tl::unexpected(other.error());
  return SourceRenderer(std::move(*other));
}

bool has_device(const SourceRenderer& renderer) {
  const auto* of_lens = std::get_if<Renderer>(&renderer);
  return of_lens != nullptr && of_lens->has_device();
}

std::string device_note(const SourceRenderer& renderer) {
  const auto* of_lens = std::get_if<Renderer>(&renderer);
  return of_lens != nullptr ? of_lens->device_note() : std::string();
}

Result<Flare> render(SourceRenderer& renderer, std::span<const Light> lights, const FrameSettings& settings,
                     const Context& context) {
  if (auto* of_lens = std::get_if<Renderer>(&renderer)) return of_lens->render(lights, settings, context);
  return render(std::get<MeasuredFlare>(renderer), lights, settings.frame, context);
}

Result<Flare> render_picture(const PictureRequest& request, SourceRenderer& renderer, const Context& context) {
  if (auto* of_lens = std::get_if<Renderer>(&renderer)) return render_picture(request, *of_lens, context);
  auto flare = render(std::get<MeasuredFlare>(renderer), request.lights, request.grid.frame, context);
  if (!flare) return flare;
  auto picture = picture_of_flare(std::move(flare->image), request.grid);
  if (!picture) return tl::unexpected(picture.error());
  flare->image = std::move(*picture);
  return flare;
}

Result<RenderStatistics> render_picture(const PictureRequest& request, SourceRenderer& renderer,
                                        const ImageView& pixels, const Context& context) {
  if (auto* of_lens = std::get_if<Renderer>(&renderer)) return render_picture(request, *of_lens, pixels, context);
  if (const auto fits = check_view(pixels, request.grid.width, request.grid.height); !fits)
    return tl::unexpected(fits.error());
  auto flare = render_picture(request, renderer, context);
  if (!flare) return tl::unexpected(flare.error());
  if (const auto written = write_pixels(flare->image, pixels, context); !written)
    return tl::unexpected(written.error());
  return std::move(flare->statistics);
}

Result<LayeredFlare> render_picture_layers(const PictureRequest& request, SourceRenderer& renderer,
                                           const LayerOptions& options, const Context& context) {
  auto* of_lens = std::get_if<Renderer>(&renderer);
  auto flare = of_lens != nullptr ? of_lens->render_layers(request.lights, request.settings, options, context)
                                  : render_layers(std::get<MeasuredFlare>(renderer), request.lights, request.grid.frame,
                                                  options, context);
  if (!flare) return flare;
  auto image = picture_of_flare(std::move(flare->image), request.grid);
  if (!image) return tl::unexpected(image.error());
  auto layers = layers_of_picture(std::move(flare->layers), request.grid);
  if (!layers) return tl::unexpected(layers.error());
  return LayeredFlare{std::move(*image), std::move(*layers), std::move(flare->statistics)};
}

Result<PictureFlare> render_flare(FlarePlan& plan, const Image& rgb, const params::Values& values,
                                  SourceRenderer& renderer, const Context& context) {
  if (auto* of_lens = std::get_if<Renderer>(&renderer)) return render_flare(plan, rgb, values, *of_lens, context);
  const auto& measured = std::get<MeasuredFlare>(renderer);
  add_range_warnings(plan, measured);
  return render_flare(plan, rgb, measured, context);
}

Result<PictureLayers> render_flare_layers(FlarePlan& plan, const Image& rgb, const params::Values& values,
                                          SourceRenderer& renderer, const LayerOptions& options,
                                          const Context& context) {
  if (auto* of_lens = std::get_if<Renderer>(&renderer))
    return render_flare_layers(plan, rgb, values, *of_lens, options, context);
  const auto& measured = std::get<MeasuredFlare>(renderer);
  add_range_warnings(plan, measured);
  return render_flare_layers(plan, rgb, measured, options, context);
}

Result<AppliedFlare> apply_flare(Picture& picture, const FlareSource& source, const params::Values& values,
                                 const Context& context) {
  if (const auto* measured = std::get_if<MeasuredFlare>(&source))
    if (auto good = check_measured_values(*measured, values, MeasuredUse::Photograph); !good)
      return tl::unexpected(good.error());
  auto plan = plan_flare(picture, geometry_of(source), values);
  if (!plan) return tl::unexpected(plan.error());
  auto renderer = renderer_of(values, source);
  if (!renderer) return tl::unexpected(renderer.error());
  auto flare = render_flare(*plan, picture.rgb, values, *renderer, context);
  if (!flare) return tl::unexpected(flare.error());
  add_flare(picture.rgb, flare->image);
  return AppliedFlare{std::move(*plan), std::move(*flare)};
}

}  // namespace contrejour
