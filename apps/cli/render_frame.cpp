// SPDX-License-Identifier: Apache-2.0
#include "cli/render_frame.h"

#include <utility>

#include <fmt/format.h>

#include "cli/flare_report.h"
#include "cli/options.h"
#include "contrejour/expert/picture_layers.h"
#include "contrejour/expert/preview_exposure.h"
#include "contrejour/expert/settings.h"
#include "contrejour/image_io.h"

namespace contrejour::cli {
namespace {

Result<RenderFiles> open_render_files(const RenderOptions& options, Outputs& outputs) {
  RenderFiles files;
  const std::pair<const std::string&, OutputFile*&> all[] = {{options.output, files.output},
                                                             {options.preview, files.preview},
                                                             {options.stats, files.stats},
                                                             {options.preset.save, files.preset}};
  if (auto ok = outputs.add_all(all); !ok) return tl::unexpected(ok.error());
  return files;
}

Result<PictureRequest> request_of(const params::Values& values, bool needs_light, const FlareSource& source,
                                  const LensState& lens) {
  const auto without = needs_light ? WithoutLights::DefaultLight : WithoutLights::Dark;
  if (const auto* measured = std::get_if<MeasuredFlare>(&source))
    return picture_request(values, *measured, {}, without);
  return picture_request(values, lens, {}, without);
}

Result<void> write_image(const RenderedFrame& rendered, const PreviewSettings& preview, const Context& context) {
  const auto& [planned, flare, layers, drawn] = rendered;
  const std::string ending = lower_extension(planned.options.output);
  const bool is_linear = planned.options.colour.output_space.empty();
  if (ending == ".png" && is_linear) return write_preview_png(*planned.files.output, flare.image, preview, context);
  Picture picture = picture_of(flare.image);
  picture.exr_compression = planned.options.compression;
  set_colour_space(picture, planned.request.settings.colour_space);
  set_pixel_aspect(picture, planned.request.pixel_aspect);
  if (ending != ".exr" || !is_linear)
    return write_plate(*planned.files.output, picture, nullptr, planned.options.colour, context);
  if (planned.options.layers.on()) add_layers(picture, layers, planned.options.layers);
  return write_picture(*planned.files.output, picture, context);
}

// The flare of a request, with layers where the options ask for them.
Result<LayeredFlare> draw_request(const PictureRequest& request, const LayerChoice& layers, SourceRenderer& renderer,
                                  const Context& context) {
  if (layers.on()) {
    const auto options = layer_options(layers);
    if (!options) return tl::unexpected(options.error());
    return render_picture_layers(request, renderer, *options, context);
  }
  auto flare = render_picture(request, renderer, context);
  if (!flare) return tl::unexpected(flare.error());
  return LayeredFlare{std::move(flare->image), {}, std::move(flare->statistics)};
}

// Drawn once, or as often as the change of its parameters while the shutter is open needs.
Result<ExposedFlare> draw_frame(const PlannedFrame& planned, SourceRenderer& renderer, const Context& context) {
  const RenderOptions& options = planned.options;
  if (!planned.exposure) {
    auto flare = draw_request(planned.request, options.layers, renderer, context);
    if (!flare) return tl::unexpected(flare.error());
    return ExposedFlare{std::move(*flare), 1, 0.0};
  }
  return planned.exposure->expose(
      [&](const FrameMoment& moment, const Context& within) -> Result<LayeredFlare> {
        const auto request = request_of(moment.values, options.needs_light, planned.exposure->source(), *moment.lens);
        if (!request) return tl::unexpected(request.error());
        return draw_request(*request, options.layers, renderer, within);
      },
      renderer, planned.request.settings.area_error, context);
}

}  // namespace

Result<PlannedFrame> plan_frame(const RenderOptions& options, const FlareSource& source,
                                std::shared_ptr<const LensState> lens) {
  PlannedFrame planned{options, std::move(lens), {}, {}, {}};
  const auto files = open_render_files(options, planned.outputs);
  if (!files) return tl::unexpected(files.error());
  planned.files = *files;
  auto request = request_of(options.values, options.needs_light, source, *planned.lens);
  if (!request) return tl::unexpected(request.error());
  planned.request = std::move(*request);
  return planned;
}

Result<RenderedFrame> render_frame(PlannedFrame&& planned, SourceRenderer& renderer, const Context& context) {
  auto exposed = draw_frame(planned, renderer, context);
  if (!exposed) return tl::unexpected(exposed.error());
  LayeredFlare& flare = exposed->flare;
  Flare whole{std::move(flare.image), std::move(flare.statistics)};
  return RenderedFrame{std::move(planned), std::move(whole), std::move(flare.layers), exposed->drawn};
}

Result<void> write_frame(RenderedFrame& rendered, const Context& context) {
  auto& [planned, flare, layers, drawn] = rendered;
  const auto& [options, files] = std::tie(planned.options, planned.files);
  const PreviewSettings preview =
      params::preview_settings(options.values, flare.image, params::DefaultExposure::Automatic);
  Result<void> ok = write_image(rendered, preview, context);
  if (ok && files.preview) ok = write_preview_png(*files.preview, flare.image, preview, context);
  if (ok && files.preset) ok = files.preset->write(params::write_preset({{}, {}, options.lens, options.values}));
  if (ok && files.stats) ok = files.stats->write(json_text(stats_json(flare.statistics)));
  return ok ? planned.outputs.commit() : ok;
}

Json frame_json(const RenderedFrame& rendered) {
  const auto& [planned, flare, layers, drawn] = rendered;
  return {{"lens", planned.lens->name},
          {"output", planned.options.output},
          {"lights", planned.request.lights.size()},
          {"drawn", drawn},
          {"statistics", stats_json(flare.statistics)}};
}

std::string frame_text(const RenderedFrame& rendered) {
  const auto& [planned, flare, layers, drawn] = rendered;
  return fmt::format("{}: {} x {}, {} ghosts, {:.2f} s\n", planned.options.output, flare.image.width,
                     flare.image.height, flare.statistics.ghosts_rendered, total_ms(flare.statistics) / 1000.0);
}

}  // namespace contrejour::cli
