// SPDX-License-Identifier: Apache-2.0
// contrejour apply: adds the flare of a photograph's own lights to it.
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "cli/apply_report.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/flare_report.h"
#include "cli/lens_choice.h"
#include "cli/long_task.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/preset_choice.h"
#include "contrejour/apply.h"
#include "contrejour/expert/apply_files.h"
#include "contrejour/expert/preview_exposure.h"

namespace contrejour::cli {
namespace {

constexpr const char* kApplyExamples =
    "Bright areas of the picture become lights at their positions, and the flare that they cause in the lens is\n"
    "added. Everything else in the file is unchanged; a picture without lights is copied bit for bit. IN and OUT\n"
    "may be the same file. Without --hfov the picture is assumed to fill the lens's sensor. --light and --light-at\n"
    "add lights that are not in the picture, such as a sun outside the frame.\n\n"
    "Examples:\n"
    "  contrejour apply canon-70-200 --focal 135 plate.exr -o out.exr --preview out.png\n"
    "  contrejour apply heliar -f 16 plate.exr -o out.exr --flare-only flare.exr --hfov 40 --json\n"
    "  contrejour apply nikon-80-200 plate.exr -o out.exr --threshold 50 --max-lights 8 --stops 3\n"
    "  contrejour apply planar-50 plate.exr -o out.exr --region 0.6,0,1,0.4 --detected lights.png\n"
    "  contrejour apply heliar plate.exr -o out.exr --no-detect --light-at 1.1,-0.1:2e6\n"
    "  contrejour apply heliar comp.exr -o out.exr --layer beauty";

struct ApplyOptions {
  std::string lens, input, output, flare_only, detected, preview;
  bool json = false;
  ReadOptions read;
  PresetOptions preset;
  params::Values values;
};

struct ApplyFiles {
  OutputFile* output = nullptr;
  OutputFile *flare_only = nullptr, *detected = nullptr, *preview = nullptr, *preset = nullptr;  // or null
};

Result<ApplyFiles> open_apply_files(const ApplyOptions& options, Outputs& outputs) {
  ApplyFiles files;
  const std::pair<const std::string&, OutputFile*&> all[] = {{options.output, files.output},
                                                             {options.flare_only, files.flare_only},
                                                             {options.detected, files.detected},
                                                             {options.preset.save, files.preset},
                                                             {options.preview, files.preview}};
  if (auto ok = outputs.add_all(all); !ok) return tl::unexpected(ok.error());
  return files;
}

Result<void> write_preview(const ApplyOptions& options, OutputFile& file, const Image& rgb, const Context& context) {
  const PreviewSettings preview = params::preview_settings(options.values, rgb, params::DefaultExposure::None);
  return write_preview_png(file, rgb, preview, context);
}

// The detected lights are drawn over the photograph without flare, so they are written before the flare is added.
Result<void> write_all(const ApplyOptions& options, const ApplyFiles& files, Picture& picture, const FlarePlan& plan,
                       const Image& flare) {
  const LongTask task("writing", 0);
  const Context& context = task.context();
  Result<void> ok;
  if (files.detected) ok = write_detected(*files.detected, picture, plan, context);
  if (!ok) return ok;
  add_flare(picture.rgb, flare);
  ok = plan.lights.empty() ? copy_photograph(*files.output, options.input, picture, options.values, context)
                           : write_photograph(*files.output, picture, options.values, context);
  if (ok && files.flare_only) ok = write_aligned(*files.flare_only, flare, picture, plan, context);
  if (ok && files.preset) ok = files.preset->write(params::write_preset({{}, {}, options.lens, options.values}));
  if (ok && files.preview) ok = write_preview(options, *files.preview, picture.rgb, context);
  return ok;
}

void report(const ApplyOptions& options, const LensState& lens, const FlarePlan& plan, const PictureFlare& flare) {
  if (!options.json) {
    print_summary(report_text(plan) + visibility_text(flare.visibility, plan.lights.size()));
    print_summary(fmt::format("{}: {} ghosts, {:.2f} s\n", options.output, flare.statistics.ghosts_rendered,
                              total_ms(flare.statistics) / 1000.0));
    return;
  }
  Json json = {{"lens", lens.name}, {"input", options.input}, {"output", options.output}};
  json.update(report_json(plan));
  json["flare"] = visibility_json(flare.visibility);
  json["statistics"] = plan.lights.empty() ? Json() : stats_json(flare.statistics);
  print_json(json);
}

Result<FlarePlan> plan_of_file(const ApplyOptions& options, const Picture& picture, const LensState& lens) {
  auto plan = plan_flare(picture, lens, options.values);
  if (plan) {
    print_warnings(plan->warnings);
  } else if (plan.error().place.file.empty()) {
    plan.error().place.file = options.input;
  }
  return plan;
}

Result<PictureFlare> render_planned(const ApplyOptions& options, const FlarePlan& plan, const Image& rgb,
                                    const LensState& lens) {
  const LongTask task("rendering", options.values.integer("threads"));
  return render_flare(plan, rgb, lens, options.values, task.context());
}

Result<int> run_apply(ApplyOptions options) {
  if (const auto ok = fill_from_preset(options.preset, options.lens, options.values); !ok)
    return tl::unexpected(ok.error());
  Outputs outputs;
  const auto files = open_apply_files(options, outputs);
  if (!files) return tl::unexpected(files.error());
  const auto lens = open_lens(options.lens, options.values);
  if (!lens) return tl::unexpected(lens.error());
  auto picture = read_picture(options.input, options.read);
  if (!picture) return tl::unexpected(picture.error());
  const auto plan = plan_of_file(options, *picture, *lens);
  if (!plan) return tl::unexpected(plan.error());
  const auto flare = render_planned(options, *plan, picture->rgb, *lens);
  if (!flare) return tl::unexpected(flare.error());
  if (auto ok = write_all(options, *files, *picture, *plan, flare->image); !ok) return tl::unexpected(ok.error());
  if (auto ok = outputs.commit(); !ok) return tl::unexpected(ok.error());
  report(options, *lens, *plan, *flare);
  return kDone;
}

// The error if only one of LENS and IN is given.
CLI::ParseError missing_argument(const std::string& given) {
  const std::string ending = lower_extension(given);
  if (ending != ".exr" && ending != ".png") return CLI::RequiredError("IN");
  return CLI::RequiredError(
      fmt::format("LENS before {} (`contrejour lens list`, or a preset that names a lens, --preset)", given));
}

}  // namespace

void add_apply(CLI::App& app, Action& action) {
  const auto options = std::make_shared<ApplyOptions>();
  CLI::App* command = app.add_subcommand("apply", "add the flare of a lens to a photograph");
  add_lens_argument(*command, options->lens);
  command->add_option("IN", options->input, "the photograph: a scene-linear EXR, or a PNG")->option_text(" ");
  add_picture_choice(*command, options->read);
  add_output(*command, "-o,--output", options->output, {".exr", ".png"}, "the photograph with flare")->required();
  add_output(*command, "--flare-only", options->flare_only, {".exr"}, "the flare alone");
  add_output(
      *command, "--detected", options->detected, {".exr", ".png"},
      "the detected lights: an EXR of their pixels, or a PNG of the picture in grey with each light in a colour");
  add_output(*command, "--preview", options->preview, {".png"}, "a preview of the result as PNG");
  command->add_flag("--json", options->json, "print the report on the detected lights as JSON");
  add_preset_options(*command, options->preset);
  add_parameters(*command, options->values, {"exposure"});
  add_parameters(*command, options->values,
                 {"detect", "region", "threshold", "softness", "max-lights", "min-pixels", "max-value", "light-shape",
                  "spectrum", "gain", "stops"});
  add_parameters(*command, options->values,
                 {"light", "light-at", "value", "colour", "light-size", "light-distance", "iso", "shutter"});
  add_lens_parameters(*command, options->values);
  add_parameters(*command, options->values, {"hfov", "pixel-aspect"});
  add_rendering_parameters(*command, options->values);
  command->footer(kApplyExamples);
  command->callback([options, &action] {
    if (options->input.empty()) {
      if (options->preset.name.empty()) throw missing_argument(options->lens);
      std::swap(options->lens, options->input);  // the lens comes from the preset
    }
    action = [options] { return run_apply(*options); };
  });
}

}  // namespace contrejour::cli
