// SPDX-License-Identifier: Apache-2.0
// contrejour ghosts: lists the ghosts of a lens, the brightest first, or the worst case of each as a setting changes.
#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/ghost_report.h"
#include "cli/ghost_sweep.h"
#include "cli/heat_map.h"
#include "cli/lens_choice.h"
#include "cli/long_task.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "contrejour/expert/requests.h"
#include "contrejour/expert/settings.h"
#include "contrejour/expert/write_lens.h"

namespace contrejour::cli {
namespace {

constexpr const char* kGhostsExamples =
    "flux: the flux of the ghost relative to the direct image's, also outside the frame. peak: its largest\n"
    "irradiance, averaged over a pixel, relative to the irradiance at the front of the lens. R x R: product of the\n"
    "reflectances of its surfaces at normal incidence. x, y, w, h: centroid, width and height in pixels of --size,\n"
    "and in mm on the sensor, where the right and top of the picture are negative. R, G, B: flux by channel for a\n"
    "white light. focus: distance from the sensor to the paraxial focus of the ghost, positive behind the sensor.\n"
    "blur: first-order diameter of its spot on the sensor. Flags: focus, the spot is at most 1 per cent of the\n"
    "picture's diagonal; pupil, an image of the stop that stays at the centre of the picture for every light.\n\n"
    "Examples:\n"
    "  contrejour ghosts heliar -f 16\n"
    "  contrejour ghosts canon-70-200 --focal 200 --light 4,3 --sort peak --csv\n"
    "  contrejour ghosts canon-70-200 -f 8 --sweep field --sort peak -o map.svg\n"
    "  contrejour ghosts heliar --coating-at 4:v-coat --sweep fnumber:4.5:22 --steps 6 --json\n"
    "  contrejour ghosts heliar -f 8 --path 2-5 -o ghost.zmx";

struct GhostsOptions {
  std::string lens, sort = "flux", sweep, path, output;
  int steps = 13;
  bool json = false, csv = false;
  params::Values values;
};

GhostOrder order_of(const std::string& sort) {
  if (sort == "peak") return GhostOrder::Peak;
  if (sort == "size") return GhostOrder::Size;
  return sort == "focus" ? GhostOrder::Focus : GhostOrder::Flux;
}

Json report_json(const LensState& lens, const FiguresRequest& request, const std::vector<GhostFigures>& figures) {
  const LightAngles angles = angles_from_direction(request.light.direction);
  return {{"lens", lens.name},
          {"light",
           {{"azimuth_deg", angles.azimuth_rad / params::kDegree_rad},
            {"elevation_deg", angles.elevation_rad / params::kDegree_rad}}},
          {"frame",
           {{"width", request.frame.width},
            {"height", request.frame.height},
            {"pixel_pitch_mm", request.frame.pixel_pitch_mm}}},
          {"ghosts", ghosts_json(figures)}};
}

Result<int> run_figures(const GhostsOptions& options) {
  const params::Values& values = options.values;
  const auto lens = open_lens(options.lens, values);
  if (!lens) return tl::unexpected(lens.error());
  const auto request = figures_request(values, *lens);
  if (!request) return tl::unexpected(request.error());
  const LongTask task("measuring", values.integer("threads"));
  auto figures = ghost_figures(*lens, *request, task.context());
  if (!figures) return tl::unexpected(figures.error());
  sort_ghosts(*figures, order_of(options.sort));
  if (options.json) {
    print_json(report_json(*lens, *request, *figures));
  } else {
    print(options.csv ? ghosts_csv(*figures) : ghosts_text(*figures));
  }
  return kDone;
}

Result<int> run_sweep(const GhostsOptions& options) {
  Outputs outputs;
  const auto map = outputs.add(options.output);
  if (!map) return tl::unexpected(map.error());
  const SweepQuantity quantity = options.sort == "peak" ? SweepQuantity::Peak : SweepQuantity::Flux;
  auto sweep = sweep_ghosts(options.lens, options.values, *parse_sweep(options.sweep), options.steps);
  if (!sweep) return tl::unexpected(sweep.error());
  sort_by_worst(*sweep, quantity);
  if (*map != nullptr) {
    if (const auto ok = (*map)->write(heat_map(*sweep, quantity)); !ok) return tl::unexpected(ok.error());
    if (const auto ok = outputs.commit(); !ok) return tl::unexpected(ok.error());
  }
  if (options.json) {
    print_json(sweep_json(*sweep));
  } else {
    print(options.csv ? sweep_csv(*sweep) : sweep_text(*sweep));
  }
  return kDone;
}

Result<int> run_path(const GhostsOptions& options) {
  Outputs outputs;
  const auto file = outputs.add(options.output);
  if (!file) return tl::unexpected(file.error());
  const auto lens = open_lens(options.lens, options.values);
  if (!lens) return tl::unexpected(lens.error());
  const auto ghost = choose_ghost(*lens, options.path);
  if (!ghost) return tl::unexpected(ghost.error());
  const bool is_zemax = lower_extension(options.output) == ".zmx";
  const auto written = is_zemax ? write_ghost_zmx(*lens, *ghost) : write_ghost_seq(*lens, *ghost);
  if (!written) return tl::unexpected(written.error());
  if (const auto ok = (*file)->write(written->text); !ok) return tl::unexpected(ok.error());
  if (const auto ok = outputs.commit(); !ok) return tl::unexpected(ok.error());
  print_warnings(written->losses);
  return kDone;
}

// Refuses combinations of options that exclude each other.
void check_combinations(const GhostsOptions& options) {
  const params::Values& values = options.values;
  if (values.list("light").size() + values.list("light-at").size() > 1)
    throw CLI::ValidationError("--light",
                               "is given more than once; the figures are those of a single light, so give one");
  const std::string ending = lower_extension(options.output);
  if (!options.path.empty()) {
    if (!options.sweep.empty())
      throw CLI::ValidationError("--path", "writes the path of one configuration; leave out --sweep");
    if (ending != ".zmx" && ending != ".seq")
      throw CLI::ValidationError("--output", "has another extension; the path needs a name that ends in .zmx or .seq");
    return;
  }
  if (options.sweep.empty()) {
    if (!options.output.empty())
      throw CLI::ValidationError("--output", "has no content; give --sweep for a heat map, or --path for a lens file");
    return;
  }
  if (!options.output.empty() && ending != ".svg")
    throw CLI::ValidationError("--output", "has another extension; the heat map needs a name that ends in .svg");
  if (options.sort == "size" || options.sort == "focus")
    throw CLI::ValidationError("--sort", "does not apply to a sweep; sort a sweep by flux or peak");
  const SweepAxis axis = parse_sweep(options.sweep)->axis;
  if ((axis == SweepAxis::Focal && values.given("focal")) || (axis == SweepAxis::FNumber && values.given("fnumber")))
    throw CLI::ValidationError("--sweep", "varies a setting that another option fixes; leave out that option");
}

}  // namespace

void add_ghosts(CLI::App& app, Action& action) {
  const auto options = std::make_shared<GhostsOptions>();
  CLI::App* command =
      app.add_subcommand("ghosts", "list the ghosts: flux, peak, position, size, colour, focus; sweep a setting");
  add_lens_argument(*command, options->lens);
  CLI::Option* json = command->add_flag("--json", options->json, "print JSON");
  command->add_flag("--csv", options->csv, "print comma-separated values")->excludes(json);
  command
      ->add_option(
          "--sort", options->sort,
          "order of the ghosts: flux or peak (brightest first), size (smallest first), focus (nearest to focus first)")
      ->check(CLI::IsMember({"flux", "peak", "size", "focus"}))
      ->option_text("flux|peak|size|focus");
  const auto problem = [](const std::string& text) {
    const auto range = parse_sweep(text);
    return range ? std::string() : range.error().message;
  };
  command
      ->add_option("--sweep", options->sweep,
                   "the worst case of each ghost over field angles (in the plane of --light and the axis), focal "
                   "lengths or f-numbers")
      ->check(CLI::Validator(problem, "", "sweep"))
      ->option_text("field|focal|fnumber[:FROM:TO]");
  add_number(*command, "--steps", options->steps, 2, 200, "number of steps of a sweep");
  add_ghost_option(*command, "--path", options->path,
                   "write the optical path of this ghost as a sequential lens file for optical design programs");
  add_output(*command, "-o,--output", options->output, {".svg", ".zmx", ".seq"},
             "the heat map of a sweep, ghosts by steps (.svg), or the file of a path (.zmx, .seq)");
  add_parameters(*command, options->values, {"light", "light-at", "colour", "light-distance"});
  add_lens_parameters(*command, options->values);
  hide_parameters(*command, kDirt);
  add_parameters(*command, options->values,
                 {"wavelength", "size", "hfov", "wavelengths", "ghosts", "reflections", "threads"});
  command->footer(kGhostsExamples);
  command->callback([options, &action] {
    check_combinations(*options);
    action = [options] {
      if (!options->path.empty()) return run_path(*options);
      return options->sweep.empty() ? run_figures(*options) : run_sweep(*options);
    };
  });
}

}  // namespace contrejour::cli
