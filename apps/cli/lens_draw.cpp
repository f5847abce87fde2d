// SPDX-License-Identifier: Apache-2.0
// contrejour lens draw: draws a section of the lens with rays as SVG.
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/lens_choice.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "contrejour/expert/lens_section.h"
#include "contrejour/expert/settings.h"
#include "contrejour/light.h"

namespace contrejour::cli {
namespace {

constexpr const char* kLensDrawExamples =
    "Without --ghost, the drawing shows the rays that form the image on the axis and at the corner of the field.\n"
    "With --ghost, it shows the rays that form the direct image of a light, and in other colours those along the\n"
    "optical paths of the ghosts (dashed if all are blocked). The section lies in the plane of the light.\n\n"
    "Examples:\n"
    "  contrejour lens draw heliar -o heliar.svg\n"
    "  contrejour lens draw canon-70-200 --focal 135 -f 8 --ghost 3-14 --light 0,4 -o ghost.svg\n"
    "  contrejour lens draw heliar --ghost 2-5,4-5 -o two.svg";

struct DrawOptions {
  std::string lens, output;
  std::vector<std::string> ghosts;
  params::Values values;
};

// The light's angle from the axis, positive if the light is above it.
Result<std::optional<double>> light_angle_rad(const params::Values& values, const LensState& lens) {
  if (!values.given("light")) return std::optional<double>();
  const auto lights = params::lights(values, lens, frame_on_sensor(lens, 3, 2), ColourSpace::Rec709);
  if (!lights) return tl::unexpected(lights.error());
  const Vec3 d = lights->front().direction;
  return std::optional<double>(std::copysign(std::atan2(std::hypot(d.x, d.y), d.z), -d.y));
}

Result<int> run_draw(const DrawOptions& options) {
  Outputs outputs;
  const auto file = outputs.add(options.output);
  if (!file) return tl::unexpected(file.error());
  const auto lens = open_lens(options.lens, options.values);
  if (!lens) return tl::unexpected(lens.error());
  SectionRequest request;
  request.lambda_nm = wavelength_nm(options.values, *lens);
  for (const std::string& text : options.ghosts) {
    const auto ghosts = choose_ghosts(*lens, text);
    if (!ghosts) return tl::unexpected(ghosts.error());
    request.ghosts.insert(request.ghosts.end(), ghosts->begin(), ghosts->end());
  }
  const auto angle_rad = light_angle_rad(options.values, *lens);
  if (!angle_rad) return tl::unexpected(angle_rad.error());
  request.ghost_light_rad = *angle_rad;
  const std::string drawing = section_svg(lens_section(*lens, request));
  if (const auto ok = (*file)->write(drawing); !ok) return tl::unexpected(ok.error());
  if (const auto ok = outputs.commit(); !ok) return tl::unexpected(ok.error());
  return kDone;
}

}  // namespace

void add_lens_draw(CLI::App& lens, Action& action) {
  const auto options = std::make_shared<DrawOptions>();
  CLI::App* command = lens.add_subcommand("draw", "draw the lens in section, with rays, as SVG");
  command->alias("layout");
  add_lens_argument(*command, options->lens);
  add_output(*command, "-o,--output", options->output, {".svg"}, "the drawing")->required();
  add_ghosts_option(*command, options->ghosts,
                    "the ghost whose optical path is drawn; may be repeated, or several with commas");
  add_parameters(*command, options->values, {"light"});
  add_lens_parameters(*command, options->values);
  for (const auto names : {std::span<const std::string_view>(kIris), {kGrating}, {kDirt}})
    hide_parameters(*command, names);
  hide_parameters(*command, std::array<std::string_view, 3>{"absorption", "coating", "coating-at"});
  add_parameters(*command, options->values, {"wavelength"});
  command->footer(kLensDrawExamples);
  command->callback([options, &action] {
    if (options->values.given("light") && options->ghosts.empty()) {
      throw CLI::ValidationError("--light", "applies to the optical path of a ghost only; give --ghost as well");
    }
    if (options->values.list("light").size() > 1)
      throw CLI::ValidationError("--light", "is given more than once; one light is drawn, so give one");
    action = [options] { return run_draw(*options); };
  });
}

}  // namespace contrejour::cli
