// SPDX-License-Identifier: Apache-2.0
// contrejour render: a lens and lights -> the flare as an image.
#include <memory>
#include <string>
#include <utility>

#include "cli/animation_option.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/frame_lens.h"
#include "cli/lens_choice.h"
#include "cli/long_task.h"
#include "cli/options.h"
#include "cli/preset_choice.h"
#include "cli/render_frame.h"
#include "cli/render_sequence.h"
#include "cli/sequence_options.h"
#include "cli/source_choice.h"

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
    "  contrejour render --preset old-portrait --blades 7 -o flare.exr --save-preset mine.toml\n"
    "  contrejour render heliar -o flare.####.exr --frames 1-48 --lights lights.toml\n"
    "  contrejour render heliar -o flare.exr --starburst --layers part";

Result<PlannedFrame> plan_still(const RenderOptions& options, const FrameValues& values, const FrameLens& lens) {
  const auto state = lens.at(options.values);
  if (!state) return tl::unexpected(state.error());
  auto planned = plan_frame(options, lens.first_source(), *state);
  if (!planned) return planned;
  planned->exposure = FrameExposure::create(values, lens, values.still_frame());
  LayerChoice& layers = planned->options.layers;
  if (planned->exposure && chooses_ghosts(layers))  // the same at all times of the exposure
    if (auto ok = choose_ghosts(layers, **state, planned->request.lights, options.values, planned->request.settings);
        !ok)
      return tl::unexpected(ok.error());
  return planned;
}

Result<int> render_still(const RenderOptions& options, const FrameValues& values) {
  const auto lens = FrameLens::create(options.lens, values, values.still_frame(), MeasuredUse::Lights);
  if (!lens) return tl::unexpected(lens.error());
  auto planned = plan_still(options, values, *lens);
  if (!planned) return tl::unexpected(planned.error());
  print_warnings(planned->request.warnings);
  auto renderer = open_renderer(options.values, lens->first_source());
  if (!renderer) return tl::unexpected(renderer.error());
  auto rendered = [&] {
    const LongTask task("rendering", options.values.integer("threads"));
    return render_frame(std::move(*planned), *renderer, task.context());
  }();
  if (!rendered) return tl::unexpected(rendered.error());
  const LongTask task("writing", 0);
  if (auto ok = write_frame(*rendered, task.context()); !ok) return tl::unexpected(ok.error());
  if (options.json) {
    print_json(frame_json(*rendered));
  } else {
    print_summary(frame_text(*rendered));
  }
  return kDone;
}

Result<int> run_render(RenderOptions options, const SequenceOptions& sequence) {
  if (auto ok = check_layer_options(options.layers, options.output, "-o"); !ok) return tl::unexpected(ok.error());
  if (options.layers.on() && !options.colour.output_space.empty())
    return failure(ErrorCode::InvalidArgument, "layers are scene-linear: leave out --output-space", {options.output});
  const params::Values command_line = options.values;
  if (const auto ok = fill_from_preset(options.preset, options.lens, options.values); !ok)
    return tl::unexpected(ok.error());
  const auto values = FrameValues::create({options.lights, sequence.frames.empty() ? "" : options.preset.session},
                                          command_line, options.values);
  if (!values) return tl::unexpected(values.error());
  options.needs_light = !values->have_lights();
  if (!sequence.frames.empty()) return render_sequence(options, *values, sequence);
  if (is_sequence(options.output))
    return failure(ErrorCode::InvalidArgument, "a sequence needs its frames: --frames 1-48", {options.output});
  if (auto ok = check_is_not_listed(sequence); !ok) return tl::unexpected(ok.error());
  options.values = values->of_still();
  options.layers.light_names = values->light_names(values->still_frame());
  options.layers.off_names = values->off_names(values->still_frame());
  return render_still(options, *values);
}

}  // namespace

void add_render(CLI::App& app, Action& action) {
  const auto options = std::make_shared<RenderOptions>();
  const auto sequence = std::make_shared<SequenceOptions>();
  CLI::App* command = app.add_subcommand("render", "render the flare of lights in a lens as an image");
  add_lens_argument(*command, options->lens)->required(false);
  add_output(*command, "-o,--output", options->output,
             {".exr", ".png", ".dpx", ".tif", ".tiff", ".jpg", ".jpeg", ".hdr"}, "the image of the flare")
      ->required();
  add_output(*command, "--preview", options->preview, {".png"}, "a preview as PNG");
  add_output(*command, "--stats", options->stats, {".json"}, "statistics of the rendering: times and counts");
  command->add_flag("--json", options->json, "print a report as JSON; in a sequence, one line for each frame");
  add_sequence_options(*command, *sequence, SequenceInput::None);
  add_preset_options(*command, options->preset);
  add_layer_options(*command, options->layers);
  add_plate_colour(*command, options->colour, PlateUse::Write);
  add_exr_compression(*command, options->compression);
  add_parameters(*command, options->values, {"exposure"});
  add_parameters(*command, options->values,
                 {"light", "light-at", "value", "colour", "light-size", "light-distance", "iso", "shutter",
                  "shutter-angle", "shutter-offset"});
  add_others_of_group(*command, options->values, "Lights");
  add_animation_option(*command, options->lights);
  add_lens_parameters(*command, options->values);
  add_parameters(*command, options->values, {"size", "hfov", "pixel-aspect"});
  add_others_of_group(*command, options->values, "Frame");
  add_rendering_parameters(*command, options->values);
  command->footer(kRenderExamples);
  command->callback([options, sequence, &action] {
    if (options->lens.empty() && options->preset.name.empty() && options->preset.session.empty())
      throw CLI::RequiredError("LENS");
    action = [options, sequence] { return run_render(*options, *sequence); };
  });
}

}  // namespace contrejour::cli
