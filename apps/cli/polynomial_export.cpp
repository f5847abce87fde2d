// SPDX-License-Identifier: Apache-2.0
// contrejour polynomial export: source code of ghosts' polynomials.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/polynomial.h"

namespace contrejour::cli {
namespace {

constexpr const char* kExportExamples =
    "The code defines flare_ray(ghost, field, x_mm, y_mm, lambda_nm), self-contained with its tables; a comment says\n"
    "what it takes, and which ghosts it has. Without --ghost these are the brightest fitted ones.\n\n"
    "Examples:\n"
    "  contrejour polynomial export heliar.poly --ghost 3-4 -o ghost.c\n"
    "  contrejour polynomial export heliar.poly --count 3 -o ghosts.glsl";

struct ExportSettings {
  std::string file, output, prefix = "flare_";
  std::vector<std::string> ghosts;
  int count = 5;
};

// The flux of the zones that are fitted, weighted by their areas.
double fitted_flux(const GhostPolynomials& ghost) {
  double sum = 0.0;
  for (const PolynomialZone& zone : ghost.zones)
    if (zone.state == PolynomialZone::State::Fitted)
      sum += zone.flux_mm2 * (zone.field_high * zone.field_high - zone.field_low * zone.field_low);
  return sum;
}

std::vector<Ghost> brightest_fitted(const LensPolynomials& polynomials, int count) {
  std::vector<std::pair<double, Ghost>> found;
  for (const GhostPolynomials& ghost : polynomials.ghosts)
    if (const double flux = fitted_flux(ghost); flux > 0.0) found.emplace_back(-flux, ghost.ghost);
  std::ranges::sort(found);
  std::vector<Ghost> ghosts;
  for (const auto& [flux, ghost] : found)
    if (ghosts.size() < static_cast<std::size_t>(count)) ghosts.push_back(ghost);
  return ghosts;
}

PolynomialLanguage language_of(const std::string& file) {
  const std::string extension = lower_extension(file);
  if (extension == ".py") return PolynomialLanguage::Python;
  return extension == ".glsl" ? PolynomialLanguage::Glsl : PolynomialLanguage::C;
}

Result<int> run_polynomial_export(const ExportSettings& settings) {
  const auto polynomials = read_polynomial_file(settings.file);
  if (!polynomials) return tl::unexpected(polynomials.error());
  std::vector<Ghost> ghosts;
  for (const std::string& name : settings.ghosts) {
    const auto ghost = params::parse_ghost(name);
    if (!ghost) return tl::unexpected(ghost.error());
    ghosts.push_back(*ghost);
  }
  if (ghosts.empty()) ghosts = brightest_fitted(*polynomials, settings.count);
  const auto code = export_polynomials(*polynomials, ghosts, language_of(settings.output), settings.prefix);
  if (!code) return tl::unexpected(code.error());
  Outputs outputs;
  const auto file = outputs.add(settings.output);
  if (!file) return tl::unexpected(file.error());
  if (const auto written = (*file)->write(*code); !written) return tl::unexpected(written.error());
  if (const auto done = outputs.commit(); !done) return tl::unexpected(done.error());
  print_summary(fmt::format("{}: {} ghosts, {} bytes\n", settings.output, ghosts.size(), code->size()));
  return kDone;
}

}  // namespace

void add_polynomial_export(CLI::App& polynomial, Action& action) {
  const auto settings = std::make_shared<ExportSettings>();
  CLI::App* command = polynomial.add_subcommand("export", "write ghosts' polynomials as C, GLSL or Python");
  command->add_option("FILE", settings->file, "a file that `contrejour polynomial fit` wrote")
      ->required()
      ->option_text(" ");
  add_output(*command, "-o,--output", settings->output, {".c", ".glsl", ".py"}, "the file to write")->required();
  command->add_option("--ghost", settings->ghosts, "a ghost to export; may be repeated")->option_text("I-J");
  add_number(*command, "--count", settings->count, 1, 1000, "number of ghosts without --ghost, the brightest ones");
  command->add_option("--prefix", settings->prefix, "beginning of all names")->capture_default_str();
  command->footer(kExportExamples);
  command->callback([settings, &action] { action = [settings] { return run_polynomial_export(*settings); }; });
}

}  // namespace contrejour::cli
