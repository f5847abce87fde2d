// contrejour ghosts: each ghost of a lens, the brightest first.
#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/lens_choice.h"
#include "cli/long_task.h"
#include "cli/options.h"
#include "cli/text_table.h"
#include "contrejour/ghost_figures.h"
#include "params/settings.h"

namespace contrejour::cli {
namespace {

constexpr const char* kExamples =
    "relative flux: the ghost's flux over the direct image's, wherever it lands. peak: its largest irradiance over "
    "the\n"
    "light's at the front of the lens. Colours are relative to a white light. focus: from the sensor to where the\n"
    "ghost's near-axis light focuses, positive behind the sensor.\n\n"
    "Examples:\n"
    "  contrejour ghosts heliar -f 16\n"
    "  contrejour ghosts canon-70-200 --focal 200 --light 4,3 --json";

struct GhostsOptions {
  std::string lens;
  bool json = false;
  params::Values values;
};

// Pairs in the order of the reflections: of each pair the light meets the second first.
Json surfaces_json(const Ghost& ghost) {
  Json surfaces = {ghost.i, ghost.j};
  if (ghost.reflects_four_times()) surfaces.insert(surfaces.end(), {ghost.k, ghost.l});
  return surfaces;
}

Json ghosts_json(const LensState& lens, const FiguresRequest& request, const std::vector<GhostFigures>& figures) {
  const LightAngles angles = angles_from_direction(request.light.direction);
  Json ghosts = Json::array();
  for (const GhostFigures& g : figures) {
    ghosts.push_back({{"surfaces", surfaces_json(g.ghost)},
                      {"order", g.ghost.order},
                      {"relative_flux", g.relative_flux},
                      {"peak_irradiance", g.peak_irradiance},
                      {"centroid_px", {g.centroid_px.x, g.centroid_px.y}},
                      {"size_px", {g.size_px.x, g.size_px.y}},
                      {"rgb", g.rgb},
                      {"paraxial_focus_mm", g.paraxial_focus_mm ? Json(*g.paraxial_focus_mm) : Json()}});
  }
  return {{"lens", lens.name},
          {"light",
           {{"azimuth_deg", angles.azimuth_rad / params::kDegree_rad},
            {"elevation_deg", angles.elevation_rad / params::kDegree_rad}}},
          {"frame",
           {{"width", request.frame.width},
            {"height", request.frame.height},
            {"pixel_pitch_mm", request.frame.pixel_pitch_mm}}},
          {"ghosts", ghosts}};
}

std::string ghosts_text(const std::vector<GhostFigures>& figures) {
  TextTable table(
      {"ghost", "relative flux", "peak", "x px", "y px", "width px", "height px", "R", "G", "B", "focus mm"});
  for (const GhostFigures& g : figures) {
    const auto number = [](double value) { return fmt::format("{:.3g}", value); };
    const auto place = [](double value) { return fmt::format("{:.1f}", value); };
    table.add({ghost_name(g.ghost), number(g.relative_flux), number(g.peak_irradiance), place(g.centroid_px.x),
               place(g.centroid_px.y), place(g.size_px.x), place(g.size_px.y), number(g.rgb[0]), number(g.rgb[1]),
               number(g.rgb[2]), g.paraxial_focus_mm ? place(*g.paraxial_focus_mm) : "-"});
  }
  return table.text();
}

std::vector<SpectralBand> bands_for(const params::Values& values, const Light& light) {
  if (const auto lambda_nm = values.real("wavelength")) return {{*lambda_nm, {1.0, 1.0, 1.0}}};
  return spectral_bands(values.integer("wavelengths"), light.spectrum, ColourSpace::Rec709);
}

Result<int> run_ghosts(const GhostsOptions& options) {
  const params::Values& values = options.values;
  const auto lens = open_lens(options.lens, values);
  if (!lens) return tl::unexpected(lens.error());
  FiguresRequest request;
  request.frame = params::whole_frame(values, *lens, *params::parse_size(*values.text("size")));
  const auto lights = params::lights(values, *lens, request.frame, ColourSpace::Rec709);
  if (!lights) return tl::unexpected(lights.error());
  request.light = lights->front();
  request.scope = *values.text("ghosts") == "all" ? GhostScope::All : GhostScope::OneSideOfStop;
  request.reflections = params::reflections(values);
  request.bands = bands_for(values, request.light);
  const LongTask task("measuring", values.integer("threads"));
  const auto figures = ghost_figures(*lens, request, task.context());
  if (!figures) return tl::unexpected(figures.error());
  if (options.json) {
    print_json(ghosts_json(*lens, request, *figures));
  } else {
    print(ghosts_text(*figures));
  }
  return kDone;
}

}  // namespace

void add_ghosts(CLI::App& app, Action& action) {
  const auto options = std::make_shared<GhostsOptions>();
  CLI::App* command = app.add_subcommand("ghosts", "each ghost: flux, peak, place, size, colour, focus");
  add_lens_argument(*command, options->lens);
  command->add_flag("--json", options->json, "as JSON");
  add_parameters(*command, options->values, {"light", "light-at", "colour", "light-distance"});
  add_lens_parameters(*command, options->values);
  hide_parameters(*command, kDirt);
  add_parameters(*command, options->values,
                 {"wavelength", "size", "hfov", "wavelengths", "ghosts", "reflections", "threads"});
  command->footer(kExamples);
  command->callback([options, &action] {
    if (options->values.list("light").size() + options->values.list("light-at").size() > 1) {
      throw CLI::ValidationError("--light", "the figures are of one light; give one");
    }
    action = [options] { return run_ghosts(*options); };
  });
}

}  // namespace contrejour::cli
