// contrejour apply: a photograph in, the same photograph with the lens's flare out.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/apply_report.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/exposure.h"
#include "cli/flare_report.h"
#include "cli/lens_choice.h"
#include "cli/long_task.h"
#include "cli/look_choice.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "contrejour/detected_picture.h"
#include "contrejour/flare_plan.h"
#include "contrejour/flare_visibility.h"
#include "contrejour/settings.h"

namespace contrejour::cli {
namespace {

constexpr const char* kApplyExamples =
    "Bright areas of the picture become lights where they are, and the flare they make in the lens is added. All else\n"
    "in the file stays as it is; a picture without lights comes back unchanged, bit for bit. IN and OUT may be the\n"
    "same file. Without --hfov the picture is taken to fill the lens's sensor. --light and --light-at add lights that\n"
    "the picture does not show, such as a sun outside it.\n\n"
    "Examples:\n"
    "  contrejour apply canon-70-200 --focal 135 plate.exr -o out.exr --preview out.png\n"
    "  contrejour apply heliar -f 16 plate.exr -o out.exr --flare-only flare.exr --hfov 40 --json\n"
    "  contrejour apply nikon-80-200 plate.exr -o out.exr --threshold 50 --max-lights 8 --stops 3\n"
    "  contrejour apply planar-50 plate.exr -o out.exr --region 0.6,0,1,0.4 --detected lights.png\n"
    "  contrejour apply heliar plate.exr -o out.exr --no-detect --light-at 1.1,-0.1:2e6\n"
    "  contrejour apply heliar comp.exr -o out.exr --layer beauty";

// The lights' colours stay right; only the flare's own tint is then slightly off.
constexpr const char* kGuessedSpace =
    "the picture's primaries are neither Rec.709 nor ACEScg; its flare is computed as for Rec.709 (--colour-space)";

struct ApplyOptions {
  std::string lens, input, output, flare_only, detected, preview;
  bool json = false;
  ReadOptions read;
  LookOptions look;
  params::Values values;
};

struct ApplyFiles {
  OutputFile* output = nullptr;
  OutputFile *flare_only = nullptr, *detected = nullptr, *preview = nullptr, *look = nullptr;  // where asked for
};

Result<ApplyFiles> open_files(const ApplyOptions& options, Outputs& outputs) {
  ApplyFiles files;
  const std::pair<const std::string&, OutputFile*&> all[] = {{options.output, files.output},
                                                             {options.flare_only, files.flare_only},
                                                             {options.detected, files.detected},
                                                             {options.look.save, files.look},
                                                             {options.preview, files.preview}};
  if (auto ok = outputs.add_all(all); !ok) return tl::unexpected(ok.error());
  return files;
}

// No lights: the file itself, so that not even its compression changes. Only another format needs rewriting, and what
// cannot be read twice.
Result<void> copy_input(const ApplyOptions& options, const Picture& picture, OutputFile& output,
                        const Context& context) {
  const std::string format = picture.header != nullptr ? ".exr" : ".png";
  if (lower_extension(options.output) != format || !std::filesystem::is_regular_file(options.input))
    return write_picture(output, picture, context);
  std::ifstream input(options.input, std::ios::binary);
  std::vector<char> piece(std::size_t{1} << 20);
  while (input) {
    input.read(piece.data(), static_cast<std::streamsize>(piece.size()));
    const std::string_view part(piece.data(), static_cast<std::size_t>(input.gcount()));
    if (auto ok = output.write(part); !ok) return ok;
  }
  if (input.bad() || !input.eof()) return failure(ErrorCode::Io, "cannot read the picture again", {options.input});
  return {};
}

// A picture of its own that lies where the input does.
Result<void> write_beside(OutputFile& file, const Picture& picture, const Image& image, const params::FlarePlan& plan,
                          const Context& context) {
  Picture alone = picture_of(image);
  alone.data_window = picture.data_window;
  alone.display_window = picture.display_window;
  set_colour_space(alone, plan.space);
  set_pixel_aspect(alone, plan.pixel_aspect);
  return write_picture(file, alone, context);
}

Result<void> write_detected(const ApplyOptions& options, OutputFile& file, const Picture& picture,
                            const params::FlarePlan& plan, const Context& context) {
  if (lower_extension(options.detected) == ".exr")
    return write_beside(file, picture, params::pixels_of_lights(picture.rgb, plan.found), plan, context);
  return write_preview_png(file, params::map_of_lights(picture.rgb, plan.found, plan.space), {}, context);
}

Result<Flare> render_plan(const ApplyOptions& options, const LensState& lens, const params::FlarePlan& plan) {
  if (plan.lights.empty()) return Flare{Image(plan.grid.width, plan.grid.height), {}};
  FrameSettings settings = params::frame_settings(options.values, plan.grid.frame, plan.space);
  settings.starburst.left_out = plan.already_there;
  settings.starburst.lights = plan.imaged_lights;
  const LongTask task("rendering", options.values.integer("threads"));
  auto flare = render(params::method_options(options.values), lens, plan.lights, settings, task.context());
  if (!flare) return flare;
  flare->image = params::picture_of_frame(flare->image, plan.grid);
  if (auto finite = check_finite(flare->image); !finite) return tl::unexpected(finite.error());
  return flare;
}

// The same, so much brighter.
Picture exposed(Picture picture, double stops) {
  const auto times = static_cast<float>(std::exp2(stops));
  for (float& value : picture.rgb.pixels) value *= times;
  return picture;
}

// A PNG is to look at: --exposure, where it is given, is for it as for previews.
Result<void> write_output(const ApplyOptions& options, OutputFile& file, const Picture& picture, bool is_input,
                          const Context& context) {
  if (lower_extension(options.output) == ".png" && options.values.text("exposure")) {
    const PreviewSettings look = preview_settings(options.values, picture.rgb, UsualExposure::AsItIs);
    return write_picture(file, exposed(picture, look.exposure_stops), context);
  }
  return is_input ? copy_input(options, picture, file, context) : write_picture(file, picture, context);
}

Result<void> write_all(const ApplyOptions& options, const ApplyFiles& files, Picture& picture,
                       const params::FlarePlan& plan, const Image& flare) {
  const LongTask task("writing", 0);
  const bool is_input = plan.lights.empty();
  if (files.detected) {
    if (auto ok = write_detected(options, *files.detected, picture, plan, task.context()); !ok) return ok;
  }
  if (!is_input) params::add_flare(picture.rgb, flare);
  if (auto ok = write_output(options, *files.output, picture, is_input, task.context()); !ok) return ok;
  if (files.flare_only) {
    auto ok = write_beside(*files.flare_only, picture, flare, plan, task.context());
    if (!ok) return ok;
  }
  if (files.look) {
    auto ok = files.look->write(params::write_look({{}, {}, options.lens, options.values}));
    if (!ok) return ok;
  }
  if (!files.preview) return {};
  const PreviewSettings look = preview_settings(options.values, picture.rgb, UsualExposure::AsItIs);
  return write_preview_png(*files.preview, picture.rgb, look, task.context());
}

void report(const ApplyOptions& options, const LensState& lens, const params::FlarePlan& plan,
            const params::FlareVisibility& visibility, const RenderStatistics& stats) {
  if (!options.json) {
    print_summary(report_text(plan) + visibility_text(visibility, plan.lights.size()));
    print_summary(
        fmt::format("{}: {} ghosts, {:.2f} s\n", options.output, stats.ghosts_rendered, total_ms(stats) / 1000.0));
    return;
  }
  Json json = {{"lens", lens.name}, {"input", options.input}, {"output", options.output}};
  json.update(report_json(plan));
  json["flare"] = visibility_json(visibility);
  json["statistics"] = plan.lights.empty() ? Json() : stats_json(stats);
  print_json(json);
}

Result<int> run_apply(ApplyOptions options) {
  if (const auto ok = fill_from_look(options.look, options.lens, options.values); !ok)
    return tl::unexpected(ok.error());
  Outputs outputs;
  const auto files = open_files(options, outputs);
  if (!files) return tl::unexpected(files.error());
  const auto lens = open_lens(options.lens, options.values);
  if (!lens) return tl::unexpected(lens.error());
  auto picture = read_picture(options.input, options.read);
  if (!picture) return tl::unexpected(picture.error());
  auto plan = params::plan_flare(*picture, *lens, options.values);
  if (!plan) {
    Error error = plan.error();
    if (error.place.file.empty()) error.place.file = options.input;
    return tl::unexpected(error);
  }
  if (plan->space_is_guessed) print_warnings({kGuessedSpace});
  if (plan->found.capped_pixels > 0 && !options.values.given("max-value"))
    print_warnings({fmt::format("{} pixels are brighter than {:g} and count as of that level (--max-value)",
                                plan->found.capped_pixels, plan->found.max_value)});
  const auto flare = render_plan(options, *lens, *plan);
  if (!flare) return tl::unexpected(flare.error());
  const params::FlareVisibility visibility =
      params::visibility_of(picture->rgb, flare->image, plan->found, plan->space);
  if (auto ok = write_all(options, *files, *picture, *plan, flare->image); !ok) return tl::unexpected(ok.error());
  if (auto ok = outputs.commit(); !ok) return tl::unexpected(ok.error());
  report(options, *lens, *plan, visibility, flare->statistics);
  return kDone;
}

// The error where only one of LENS and IN was given.
CLI::ParseError missing_argument(const std::string& given) {
  const std::string ending = lower_extension(given);
  if (ending != ".exr" && ending != ".png") return CLI::RequiredError("IN");
  return CLI::RequiredError(
      fmt::format("LENS before {} (`contrejour lens list`; or a look that names one, --look)", given));
}

}  // namespace

void add_apply(CLI::App& app, Action& action) {
  const auto options = std::make_shared<ApplyOptions>();
  CLI::App* command = app.add_subcommand("apply", "put the flare of a lens on a photograph");
  add_lens_argument(*command, options->lens);
  command->add_option("IN", options->input, "a scene-linear EXR, or a PNG")->option_text(" ");
  add_picture_choice(*command, options->read);
  add_output(*command, "-o,--output", options->output, {".exr", ".png"}, "the photograph with flare")->required();
  add_output(*command, "--flare-only", options->flare_only, {".exr"}, "only what the flare adds");
  add_output(*command, "--detected", options->detected, {".exr", ".png"},
             "what counts as lights: its pixels, or (PNG) the picture in grey with each light in a colour");
  add_output(*command, "--preview", options->preview, {".png"}, "a PNG of the result to look at");
  command->add_flag("--json", options->json, "report what was found as JSON");
  add_look_options(*command, options->look);
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
      if (options->look.look.empty()) throw missing_argument(options->lens);
      std::swap(options->lens, options->input);  // the look's lens
    }
    action = [options] { return run_apply(*options); };
  });
}

}  // namespace contrejour::cli
