// SPDX-License-Identifier: Apache-2.0
// contrejour apply: adds the flare of a photograph's own lights to it.
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "cli/animation_option.h"
#include "cli/apply_frame.h"
#include "cli/apply_report.h"
#include "cli/apply_sequence.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/frame_lens.h"
#include "cli/lens_choice.h"
#include "cli/long_task.h"
#include "cli/options.h"
#include "cli/preset_choice.h"
#include "cli/sequence_options.h"
#include "cli/source_choice.h"
#include "contrejour/expert/session.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

constexpr const char* kApplyExamples =
    "Bright areas of the picture become lights at their positions, and the flare that they cause in the lens is\n"
    "added. Everything else in the file is unchanged; a picture without lights is copied bit for bit. IN and OUT\n"
    "may be the same file. In a sequence, ####, @@@@ or %04d in the names stands for the number of a frame.\n"
    "Without --hfov the picture is assumed to fill the lens's sensor. --light and --light-at add lights that are\n"
    "not in the picture, such as a sun outside the frame. LENS may be a measured flare, FILE.flare.toml, which\n"
    "takes no option of a lens.\n\n"
    "Examples:\n"
    "  contrejour apply canon-70-200 --focal 135 plate.exr -o out.exr --preview out.png\n"
    "  contrejour apply heliar -f 16 plate.exr -o out.exr --flare-only flare.exr --hfov 40 --json\n"
    "  contrejour apply nikon-80-200 plate.exr -o out.exr --threshold 50 --max-lights 8 --stops 3\n"
    "  contrejour apply planar-50 plate.exr -o out.exr --region 0.6,0,1,0.4 --detected lights.png\n"
    "  contrejour apply heliar plate.exr -o out.exr --no-detect --light-at 1.1,-0.1:2e6\n"
    "  contrejour apply heliar comp.exr -o out.exr --layer beauty\n"
    "  contrejour apply heliar plate.####.exr -o out.####.exr --frames 1001-1240 --resume\n"
    "  contrejour apply heliar plate.####.dpx -o out.####.dpx --input-space logc3\n"
    "  contrejour apply heliar plate.####.exr -o out.####.exr --lights lights.toml\n"
    "  contrejour apply heliar plate.exr -o out.exr --flare-only flare.exr --layers light\n"
    "  contrejour apply --session mine.session.json -o out.exr";

Result<PlannedPhotograph> plan_still(const ApplyOptions& options, const FrameValues& values, const FrameLens& lens) {
  const auto state = lens.at(options.values);
  if (!state) return tl::unexpected(state.error());
  auto planned = read_photograph(options, *state);
  if (!planned) return planned;
  planned->exposure = FrameExposure::create(values, lens, values.still_frame());
  LayerChoice& layers = planned->options.layers;
  if (!planned->exposure || !chooses_ghosts(layers)) return planned;
  const FrameSettings settings = params::frame_settings(options.values, planned->plan.grid.frame, planned->plan.space);
  auto ok = choose_ghosts(layers, **state, planned->plan.lights, options.values, settings);
  return ok ? std::move(planned) : tl::unexpected(ok.error());
}

Result<int> apply_to_still(const ApplyOptions& options, const FrameValues& values) {
  const auto lens = FrameLens::create(options.lens, values, values.still_frame(), MeasuredUse::Photograph);
  if (!lens) return tl::unexpected(lens.error());
  auto planned = plan_still(options, values, *lens);
  if (!planned) return tl::unexpected(planned.error());
  auto renderer = open_renderer(options.values, lens->first_source());
  if (!renderer) return tl::unexpected(renderer.error());
  auto flared = [&] {
    const LongTask task("rendering", options.values.integer("threads"));
    return render_photograph(std::move(*planned), *renderer, task.context());
  }();
  if (!flared) return tl::unexpected(flared.error());
  print_warnings(flared->planned.plan.warnings);
  const LongTask task("writing", 0);
  if (auto ok = write_photograph(*flared, task.context()); !ok) return tl::unexpected(ok.error());
  if (options.json) {
    print_json(frame_json(*flared));
  } else {
    const FlarePlan& plan = flared->planned.plan;
    print_summary(report_text(plan) + visibility_text(flared->flare.visibility, plan.lights.size()) +
                  frame_text(*flared));
  }
  return kDone;
}

// Without IN the session's plate is the photograph, read as the session says.
Result<void> fill_plate(ApplyOptions& options) {
  if (!options.input.empty() || options.preset.session.empty()) return {};
  const std::filesystem::path file = options.preset.session;
  const auto session = read_session(file);
  if (!session) return tl::unexpected(session.error());
  const SessionPlate& plate = session->plate;
  if (plate.file.empty())
    return failure(ErrorCode::InvalidArgument, "the session has no plate; give IN, the photograph", {file.string()});
  options.input = plate_file(plate, file).string();
  const auto fill = [](std::string& own, const std::string& from) {
    if (own.empty()) own = from;
  };
  fill(options.read.layer, plate.layer);
  fill(options.read.part, plate.part);
  fill(options.colour.input_space, plate.input_space);
  fill(options.colour.config, plate.config);
  return {};
}

Result<int> run_apply(ApplyOptions options, const SequenceOptions& sequence) {
  if (auto ok = check_layer_options(options.layers, options.flare_only, "--flare-only"); !ok)
    return tl::unexpected(ok.error());
  const params::Values command_line = options.values;
  if (const auto ok = fill_from_preset(options.preset, options.lens, options.values); !ok)
    return tl::unexpected(ok.error());
  if (const auto ok = fill_plate(options); !ok) return tl::unexpected(ok.error());
  const bool has_frames = is_sequence(options.input) || !sequence.frames.empty();
  const auto values =
      FrameValues::create({options.lights, has_frames ? options.preset.session : ""}, command_line, options.values);
  if (!values) return tl::unexpected(values.error());
  if (has_frames) return apply_to_sequence(options, *values, sequence);
  if (auto ok = check_is_not_listed(sequence); !ok) return tl::unexpected(ok.error());
  options.values = values->of_still();
  options.layers.light_names = values->light_names(values->still_frame());
  options.layers.off_names = values->off_names(values->still_frame());
  return apply_to_still(options, *values);
}

// The error if only one of LENS and IN is given.
CLI::ParseError missing_argument(const std::string& given) {
  if (given.empty()) return CLI::RequiredError("LENS");
  if (!is_plate_name(given)) return CLI::RequiredError("IN");
  return CLI::RequiredError(
      fmt::format("LENS before {} (`contrejour lens list`, or a preset that names a lens, --preset)", given));
}

}  // namespace

void add_apply(CLI::App& app, Action& action) {
  const auto options = std::make_shared<ApplyOptions>();
  const auto sequence = std::make_shared<SequenceOptions>();
  CLI::App* command = app.add_subcommand("apply", "add the flare of a lens to a photograph");
  add_lens_argument(*command, options->lens)->required(false);
  command->add_option("IN", options->input, "the photograph: a scene-linear EXR, a PNG, DPX, TIFF, JPEG or HDR")
      ->option_text(" ");
  add_picture_choice(*command, options->read);
  add_plate_colour(*command, options->colour, PlateUse::ReadAndWrite);
  add_output(*command, "-o,--output", options->output,
             {".exr", ".png", ".dpx", ".tif", ".tiff", ".jpg", ".jpeg", ".hdr"}, "the photograph with flare")
      ->required();
  add_exr_compression(*command, options->compression);
  add_output(*command, "--flare-only", options->flare_only, {".exr"}, "the flare alone");
  add_output(
      *command, "--detected", options->detected, {".exr", ".png"},
      "the detected lights: an EXR of their pixels, or a PNG of the picture in grey with each light in a colour");
  add_output(*command, "--preview", options->preview, {".png"}, "a preview of the result as PNG");
  command->add_flag("--json", options->json, "print the report on the detected lights as JSON");
  add_sequence_options(*command, *sequence, SequenceInput::Files);
  add_preset_options(*command, options->preset);
  add_layer_options(*command, options->layers);
  add_parameters(*command, options->values, {"exposure"});
  add_parameters(*command, options->values,
                 {"detect", "region", "threshold", "softness", "max-lights", "min-pixels", "max-value", "light-shape",
                  "spectrum", "gain", "stops"});
  add_others_of_group(*command, options->values, "Light detection");
  add_parameters(*command, options->values,
                 {"light", "light-at", "value", "colour", "light-size", "light-distance", "iso", "shutter",
                  "shutter-angle", "shutter-offset"});
  add_others_of_group(*command, options->values, "Lights");
  add_animation_option(*command, options->lights);
  add_lens_parameters(*command, options->values);
  add_parameters(*command, options->values, {"hfov", "pixel-aspect"});
  add_others_of_group(*command, options->values, "Frame", "size");
  add_rendering_parameters(*command, options->values);
  command->footer(kApplyExamples);
  command->callback([options, sequence, &action] {
    if (options->input.empty()) {
      if (options->preset.name.empty() && options->preset.session.empty()) throw missing_argument(options->lens);
      if (!options->lens.empty()) std::swap(options->lens, options->input);  // the lens comes from the preset
    }
    action = [options, sequence] { return run_apply(*options, *sequence); };
  });
}

}  // namespace contrejour::cli
