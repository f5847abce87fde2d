// SPDX-License-Identifier: Apache-2.0
// contrejour render: a lens and lights -> the flare as an image.
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/flare_report.h"
#include "cli/lens_choice.h"
#include "cli/long_task.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/preset_choice.h"
#include "cli/source_choice.h"
#include "contrejour/expert/pixel_grid.h"
#include "contrejour/expert/preview_exposure.h"
#include "contrejour/expert/settings.h"
#include "contrejour/image_io.h"
#include "contrejour/render.h"

namespace contrejour::cli {
namespace {

constexpr const char* kRenderExamples =
    "Without a light option there is one light at u,v = 0.70,0.33. The image contains what the flare adds to a\n"
    "photograph, in the units of the lights, without their direct images (--starburst adds these). A PNG is a\n"
    "preview, whose brightness --exposure sets. LENS may be a measured flare, FILE.flare.toml; then -f, --iso and\n"
    "--shutter scale its brightness from the exposure of its photographs (docs/measure.md).\n\n"
    "Examples:\n"
    "  contrejour render heliar -o flare.exr\n"
    "  contrejour render canon-70-200 --focal 135 -f 8 --light 6,4 --light -3,5 -o flare.exr --preview flare.png\n"
    "  contrejour render nikon-80-200 --light-at 0.7,0.33:5000:3200K --light-at 0.2,0.8:900 --size 960x540 -o f.exr\n"
    "  contrejour render heliar --select list:2-5 --method reference -o ghost.exr --stats ghost.json\n"
    "  contrejour render mine.flare.toml --light 12,5:20000 --hfov 60 -o flare.exr\n"
    "  contrejour render --preset old-portrait --blades 7 -o flare.exr --save-preset mine.toml";

struct RenderOptions {
  std::string lens, output, preview, stats;
  PresetOptions preset;
  params::Values values;
};

struct RenderFiles {
  OutputFile* output = nullptr;
  OutputFile *preview = nullptr, *stats = nullptr, *preset = nullptr;  // null where not requested
};

Result<RenderFiles> open_render_files(const RenderOptions& options, Outputs& outputs) {
  RenderFiles files;
  const std::pair<const std::string&, OutputFile*&> all[] = {{options.output, files.output},
                                                             {options.preview, files.preview},
                                                             {options.stats, files.stats},
                                                             {options.preset.save, files.preset}};
  if (auto ok = outputs.add_all(all); !ok) return tl::unexpected(ok.error());
  return files;
}

struct RenderedFlare {
  Flare flare;
  double pixel_aspect = 1.0;
};

Result<RenderedFlare> render_flare(const RenderOptions& options) {
  const params::Values& values = options.values;
  const auto source = open_source(options.lens, values, MeasuredUse::Lights);
  if (!source) return tl::unexpected(source.error());
  const LensState lens = geometry_of(*source);
  const params::PixelSize size = *params::parse_size(*values.text("size"));
  const PixelWindow window{0, 0, size.width, size.height};
  const double aspect = values.real("pixel-aspect").value_or(squeeze_of(lens));
  const auto grid = pixel_grid(values, lens, window, window, aspect);
  if (!grid) return tl::unexpected(grid.error());
  const Frame& frame = grid->frame;
  const ColourSpace space = params::colour_space(values, ColourSpace::Rec709);
  const auto lights = scaled_lights(*source, params::lights(values, lens, frame, space), values);
  if (!lights) return tl::unexpected(lights.error());
  const LongTask task("rendering", values.integer("threads"));
  auto flare = render(params::method_options(values), *source, *lights, params::frame_settings(values, frame, space),
                      task.context());
  if (!flare) return tl::unexpected(flare.error());
  auto image = picture_of_flare(std::move(flare->image), *grid);
  if (!image) return tl::unexpected(image.error());
  flare->image = std::move(*image);
  return RenderedFlare{std::move(*flare), aspect};
}

Result<void> write_flare(const RenderOptions& options, const RenderFiles& files, const RenderedFlare& rendered,
                         const Context& context) {
  const Flare& flare = rendered.flare;
  const PreviewSettings preview =
      params::preview_settings(options.values, flare.image, params::DefaultExposure::Automatic);
  if (lower_extension(options.output) == ".png") {
    if (auto ok = write_preview_png(*files.output, flare.image, preview, context); !ok) return ok;
  } else {
    Picture picture = picture_of(flare.image);
    set_colour_space(picture, params::colour_space(options.values, ColourSpace::Rec709));
    set_pixel_aspect(picture, rendered.pixel_aspect);
    if (auto ok = write_picture(*files.output, picture, context); !ok) return ok;
  }
  if (files.preview) {
    if (auto ok = write_preview_png(*files.preview, flare.image, preview, context); !ok) return ok;
  }
  if (files.preset) {
    if (auto ok = files.preset->write(params::write_preset({{}, {}, options.lens, options.values})); !ok) return ok;
  }
  if (files.stats) return files.stats->write(json_text(stats_json(flare.statistics)));
  return {};
}

Result<int> run_render(RenderOptions options) {
  if (const auto ok = fill_from_preset(options.preset, options.lens, options.values); !ok)
    return tl::unexpected(ok.error());
  Outputs outputs;
  const auto files = open_render_files(options, outputs);
  if (!files) return tl::unexpected(files.error());
  const auto rendered = render_flare(options);
  if (!rendered) return tl::unexpected(rendered.error());
  const LongTask task("writing", 0);
  if (auto ok = write_flare(options, *files, *rendered, task.context()); !ok) return tl::unexpected(ok.error());
  if (auto ok = outputs.commit(); !ok) return tl::unexpected(ok.error());
  print_summary(fmt::format("{}: {} x {}, {} ghosts, {:.2f} s\n", options.output, rendered->flare.image.width,
                            rendered->flare.image.height, rendered->flare.statistics.ghosts_rendered,
                            total_ms(rendered->flare.statistics) / 1000.0));
  return kDone;
}

}  // namespace

void add_render(CLI::App& app, Action& action) {
  const auto options = std::make_shared<RenderOptions>();
  CLI::App* command = app.add_subcommand("render", "render the flare of lights in a lens as an image");
  add_lens_argument(*command, options->lens)->required(false);
  add_output(*command, "-o,--output", options->output, {".exr", ".png"}, "the image of the flare")->required();
  add_output(*command, "--preview", options->preview, {".png"}, "a preview as PNG");
  add_output(*command, "--stats", options->stats, {".json"}, "statistics of the rendering: times and counts");
  add_preset_options(*command, options->preset);
  add_parameters(*command, options->values, {"exposure"});
  add_parameters(*command, options->values,
                 {"light", "light-at", "value", "colour", "light-size", "light-distance", "iso", "shutter"});
  add_lens_parameters(*command, options->values);
  add_parameters(*command, options->values, {"size", "hfov", "pixel-aspect"});
  add_rendering_parameters(*command, options->values);
  command->footer(kRenderExamples);
  command->callback([options, &action] {
    if (options->lens.empty() && options->preset.name.empty()) throw CLI::RequiredError("LENS");
    action = [options] { return run_render(*options); };
  });
}

}  // namespace contrejour::cli
