// SPDX-License-Identifier: Apache-2.0
// contrejour polynomial at: the fit of one state of a lens, from a fit of a range of zoom or focus.
#include <memory>
#include <string>
#include <variant>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/lens_choice.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "contrejour/expert/polynomial_range.h"

namespace contrejour::cli {
namespace {

constexpr const char* kPolynomialAtExamples =
    "Renderers take the lens's state from a fit of a range by themselves; export and other programs need this.\n\n"
    "Examples:\n"
    "  contrejour polynomial at nikon.poly nikon-80-200 --focal 120 -o nikon-120.poly";

struct PolynomialAtSettings {
  std::string file, lens, output;
  params::Values values;
};

Result<int> run_polynomial_at(const PolynomialAtSettings& settings) {
  const auto fit = read_any_polynomial_file(settings.file);
  if (!fit) return tl::unexpected(fit.error());
  const auto* const range = std::get_if<LensPolynomialRange>(&*fit);
  if (range == nullptr)
    return failure(ErrorCode::InvalidArgument, "this is a fit of one state; give one of a range of zoom or focus",
                   {settings.file, 0, 0});
  const auto lens = open_lens(settings.lens, settings.values);
  if (!lens) return tl::unexpected(lens.error());
  const auto state = polynomials_at(*range, *lens);
  if (!state) return tl::unexpected(state.error());
  Outputs outputs;
  const auto file = outputs.add(settings.output);
  if (!file) return tl::unexpected(file.error());
  const std::string bytes = write_polynomials(*state);
  if (const auto written = (*file)->write(bytes); !written) return tl::unexpected(written.error());
  if (const auto done = outputs.commit(); !done) return tl::unexpected(done.error());
  print_summary(fmt::format("{}: {} ghosts, {} bytes; {:.1f} per cent of the flux must be traced\n", settings.output,
                            state->ghosts.size(), bytes.size(), 100.0 * traced_flux_fraction(*state)));
  return kDone;
}

}  // namespace

void add_polynomial_at(CLI::App& polynomial, Action& action) {
  const auto settings = std::make_shared<PolynomialAtSettings>();
  CLI::App* command = polynomial.add_subcommand("at", "write the fit of one state, from that of a range");
  command->add_option("FILE", settings->file, "a file that `contrejour polynomial fit` wrote for a range")
      ->required()
      ->option_text(" ");
  add_lens_argument(*command, settings->lens);
  add_output(*command, "-o,--output", settings->output, {".poly"}, "the file to write")->required();
  add_lens_parameters(*command, settings->values);
  command->footer(kPolynomialAtExamples);
  command->callback([settings, &action] { action = [settings] { return run_polynomial_at(*settings); }; });
}

}  // namespace contrejour::cli
