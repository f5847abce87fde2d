// SPDX-License-Identifier: Apache-2.0
#include "cli/render_frame.h"

#include <utility>

#include <fmt/format.h>

#include "cli/flare_report.h"
#include "cli/options.h"
#include "cli/source_choice.h"
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

Result<std::vector<Light>> lights_of(const RenderOptions& options, const FlareSource& source, const LensState& lens,
                                     const Frame& frame, ColourSpace space) {
  auto lights = options.needs_light ? params::lights(options.values, lens, frame, space)
                                    : params::given_lights(options.values, lens, frame, space);
  return exposed_lights(source, std::move(lights), options.values);
}

Result<void> write_image(const RenderedFrame& rendered, const PreviewSettings& preview, const Context& context) {
  const auto& [planned, flare, layers] = rendered;
  if (lower_extension(planned.options.output) == ".png")
    return write_preview_png(*planned.files.output, flare.image, preview, context);
  Picture picture = picture_of(flare.image);
  set_colour_space(picture, planned.settings.colour_space);
  set_pixel_aspect(picture, planned.pixel_aspect);
  if (planned.options.layers.on()) add_layers(picture, layers, planned.options.layers);
  return write_picture(*planned.files.output, picture, context);
}

Result<RenderedFrame> render_in_layers(PlannedFrame&& planned, SourceRenderer& renderer, const Context& context) {
  const auto of_lens = renderer_of_layers(renderer);
  if (!of_lens) return tl::unexpected(of_lens.error());
  const auto options = layer_options(planned.options.layers);
  if (!options) return tl::unexpected(options.error());
  auto flare = (*of_lens)->render_layers(planned.lights, planned.settings, *options, context);
  if (!flare) return tl::unexpected(flare.error());
  auto image = picture_of_flare(std::move(flare->image), planned.grid);
  if (!image) return tl::unexpected(image.error());
  auto layers = layers_of_picture(std::move(flare->layers), planned.grid);
  if (!layers) return tl::unexpected(layers.error());
  Flare whole{std::move(*image), std::move(flare->statistics)};
  return RenderedFrame{std::move(planned), std::move(whole), std::move(*layers)};
}

}  // namespace

Result<PlannedFrame> plan_frame(const RenderOptions& options, const FlareSource& source,
                                std::shared_ptr<const LensState> lens) {
  const params::Values& values = options.values;
  PlannedFrame planned{options, std::move(lens), {}, {}, {}, 1.0, {}, {}, {}};
  const auto files = open_render_files(options, planned.outputs);
  if (!files) return tl::unexpected(files.error());
  planned.files = *files;
  const params::PixelSize size = *params::parse_size(*values.text("size"));
  const PixelWindow window{0, 0, size.width, size.height};
  planned.pixel_aspect = values.real("pixel-aspect").value_or(squeeze_of(*planned.lens));
  auto grid = pixel_grid(values, *planned.lens, window, window, planned.pixel_aspect);
  if (!grid) return tl::unexpected(grid.error());
  planned.grid = *grid;
  const ColourSpace space = params::colour_space(values, ColourSpace::Rec709);
  auto lights = lights_of(options, source, *planned.lens, planned.grid.frame, space);
  if (!lights) return tl::unexpected(lights.error());
  planned.lights = std::move(*lights);
  planned.settings = params::frame_settings(values, planned.grid.frame, space);
  planned.warnings = range_warnings_of(source, planned.lights);
  return planned;
}

Result<RenderedFrame> render_frame(PlannedFrame&& planned, SourceRenderer& renderer, const Context& context) {
  if (planned.options.layers.on()) return render_in_layers(std::move(planned), renderer, context);
  auto flare = render(renderer, planned.lights, planned.settings, context);
  if (!flare) return tl::unexpected(flare.error());
  auto image = picture_of_flare(std::move(flare->image), planned.grid);
  if (!image) return tl::unexpected(image.error());
  flare->image = std::move(*image);
  return RenderedFrame{std::move(planned), std::move(*flare)};
}

Result<void> write_frame(RenderedFrame& rendered, const Context& context) {
  auto& [planned, flare, layers] = rendered;
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
  const auto& [planned, flare, layers] = rendered;
  return {{"lens", planned.lens->name},
          {"output", planned.options.output},
          {"lights", planned.lights.size()},
          {"statistics", stats_json(flare.statistics)}};
}

std::string frame_text(const RenderedFrame& rendered) {
  const auto& [planned, flare, layers] = rendered;
  return fmt::format("{}: {} x {}, {} ghosts, {:.2f} s\n", planned.options.output, flare.image.width,
                     flare.image.height, flare.statistics.ghosts_rendered, total_ms(flare.statistics) / 1000.0);
}

}  // namespace contrejour::cli
