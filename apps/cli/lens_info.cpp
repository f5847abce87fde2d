// SPDX-License-Identifier: Apache-2.0
// contrejour lens info: describes the surfaces and first-order properties of a lens.
#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/lens_choice.h"
#include "cli/lens_info_report.h"
#include "cli/options.h"
#include "contrejour/expert/first_order.h"
#include "contrejour/expert/seidel.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

constexpr const char* kLensInfoExamples =
    "Refractive indices and first-order properties are those at --wavelength; n_d is that of the d line. The\n"
    "thickness of the last surface is the distance to the sensor. Entrance pupil and front focal point are measured\n"
    "from surface 1, back focal point and sensor from the last surface, and the exit pupil from the sensor,\n"
    "positive towards the image.\n\n"
    "Examples:\n"
    "  contrejour lens info heliar\n"
    "  contrejour lens info canon-70-200 --focal 135 -f 4 --focus 3m --json";

struct InfoOptions {
  std::string lens;
  bool json = false;
  bool seidel = false;
  params::Values values;
};

Result<int> run_info(const InfoOptions& options) {
  auto lens = prescription_of(options.lens);
  if (!lens) return tl::unexpected(lens.error());
  auto state = params::lens_of(*lens, options.values);
  if (!state) return tl::unexpected(state.error());
  const double lambda_nm = wavelength_nm(options.values, *state);
  const FirstOrder figures = first_order(*state, lambda_nm);
  auto seidel = seidel_by_surface(*state, {.lambda_nm = lambda_nm, .half_field_rad = figures.half_field_rad});
  const LensInfo info{std::move(*lens), std::move(*state), figures, lambda_nm, std::move(seidel)};
  if (options.json) {
    print_json(info_json(info));
  } else {
    print(info_text(info) + (options.seidel ? seidel_text(info) : ""));
    print_warnings(info.state.warnings);
  }
  return kDone;
}

}  // namespace

void add_lens_info(CLI::App& lens, Action& action) {
  const auto options = std::make_shared<InfoOptions>();
  CLI::App* command = lens.add_subcommand("info", "describe a lens: its surfaces and first-order properties");
  add_lens_argument(*command, options->lens);
  command->add_flag("--json", options->json, "print JSON");
  command->add_flag("--seidel", options->seidel,
                    "also print the Seidel sums of each surface (JSON always contains them)");
  add_lens_parameters(*command, options->values);
  for (const auto names : {std::span<const std::string_view>(kIris), {kGrating}, {kDirt}})
    hide_parameters(*command, names);
  hide_parameters(*command, std::array<std::string_view, 1>{"absorption"});
  add_parameters(*command, options->values, {"wavelength"});
  command->footer(kLensInfoExamples);
  command->callback([options, &action] { action = [options] { return run_info(*options); }; });
}

}  // namespace contrejour::cli
