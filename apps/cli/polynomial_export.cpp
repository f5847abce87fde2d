// SPDX-License-Identifier: Apache-2.0
// contrejour polynomial export: source code of polynomials.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "contrejour/expert/direct_polynomials.h"
#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/polynomial.h"

namespace contrejour::cli {
namespace {

constexpr const char* kExportExamples =
    "The code defines flare_ray(ghost, field, x_mm, y_mm, lambda_nm), self-contained with its tables; a comment says\n"
    "what it takes, and which ghosts it has; with ghosts without axial symmetry, flare_ray_at(ghost, tangent_x,\n"
    "tangent_y, ...), too. Without --ghost these are the brightest fitted ones. The code of a direct\n"
    "image (`polynomial fit --direct`) defines lens_ray(), from a point of the sensor and one of the stop to the ray "
    "in\n"
    "front of the lens, and lens_sensor(), from a point of the scene to the sensor.\n\n"
    "Examples:\n"
    "  contrejour polynomial export heliar.poly --ghost 3-4 -o ghost.c\n"
    "  contrejour polynomial export heliar.poly --count 3 -o ghosts.hlsl\n"
    "  contrejour polynomial export planar-direct.poly --wavelength 550 -o planar.c";

struct ExportSettings {
  std::string file, output, prefix;
  std::vector<std::string> ghosts;
  int count = 5;
  double lambda_nm = 0.0;  // 0: all
};

// The flux of the zones that are fitted, weighted by their areas.
double fitted_flux(const GhostPolynomials& ghost) {
  double sum = 0.0;
  for (const PolynomialZone& zone : ghost.zones)
    if (zone.state == PolynomialZone::State::Fitted)
      sum += zone.flux_mm2 * (zone.field_high * zone.field_high - zone.field_low * zone.field_low);
  for (const AsymmetricZone& zone : ghost.asymmetric)
    if (zone.state == PolynomialZone::State::Fitted) sum += zone.flux_mm2 * area_of(ghost, zone);
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
  if (extension == ".hlsl") return PolynomialLanguage::Hlsl;
  return extension == ".glsl" ? PolynomialLanguage::Glsl : PolynomialLanguage::C;
}

Result<int> write_code(const ExportSettings& settings, const std::string& code, const std::string& holds) {
  Outputs outputs;
  const auto file = outputs.add(settings.output);
  if (!file) return tl::unexpected(file.error());
  if (const auto written = (*file)->write(code); !written) return tl::unexpected(written.error());
  if (const auto done = outputs.commit(); !done) return tl::unexpected(done.error());
  print_summary(fmt::format("{}: {}, {} bytes\n", settings.output, holds, code.size()));
  return kDone;
}

Result<int> run_direct_export(const ExportSettings& settings) {
  if (!settings.ghosts.empty())
    return failure(ErrorCode::InvalidArgument, "this is a fit of a direct image; it has no ghosts",
                   {settings.file, 0, 0});
  auto polynomials = read_direct_polynomial_file(settings.file);
  if (!polynomials) return tl::unexpected(polynomials.error());
  if (settings.lambda_nm > 0.0) polynomials = at_wavelength(*polynomials, settings.lambda_nm);
  const std::string prefix = settings.prefix.empty() ? "lens_" : settings.prefix;
  const auto code = export_direct_polynomials(*polynomials, language_of(settings.output), prefix);
  if (!code) return tl::unexpected(code.error());
  return write_code(settings, *code, "direct image");
}

Result<int> run_polynomial_export(const ExportSettings& settings) {
  if (is_direct_polynomial_file(settings.file)) return run_direct_export(settings);
  if (settings.lambda_nm > 0.0)
    return failure(ErrorCode::InvalidArgument, "--wavelength is for a fit of a direct image; this one has ghosts",
                   {settings.file, 0, 0});
  const auto polynomials = read_polynomial_file(settings.file);
  if (!polynomials) return tl::unexpected(polynomials.error());
  std::vector<Ghost> ghosts;
  for (const std::string& name : settings.ghosts) {
    const auto ghost = params::parse_ghost(name);
    if (!ghost) return tl::unexpected(ghost.error());
    ghosts.push_back(*ghost);
  }
  if (ghosts.empty()) ghosts = brightest_fitted(*polynomials, settings.count);
  const std::string prefix = settings.prefix.empty() ? "flare_" : settings.prefix;
  const auto code = export_polynomials(*polynomials, ghosts, language_of(settings.output), prefix);
  if (!code) return tl::unexpected(code.error());
  return write_code(settings, *code, fmt::format("{} ghosts", ghosts.size()));
}

}  // namespace

void add_polynomial_export(CLI::App& polynomial, Action& action) {
  const auto settings = std::make_shared<ExportSettings>();
  CLI::App* command = polynomial.add_subcommand("export", "write polynomials as C, GLSL, HLSL or Python");
  command->add_option("FILE", settings->file, "a file that `contrejour polynomial fit` wrote")
      ->required()
      ->option_text(" ");
  add_output(*command, "-o,--output", settings->output, {".c", ".glsl", ".hlsl", ".py"}, "the file to write")
      ->required();
  command->add_option("--ghost", settings->ghosts, "a ghost to export; may be repeated")->option_text("I-J");
  add_number(*command, "--count", settings->count, 1, 1000, "number of ghosts without --ghost, the brightest ones");
  command
      ->add_option("--wavelength", settings->lambda_nm,
                   "of a direct image: only this wavelength, nm, whose code is smaller and several times faster")
      ->check(CLI::Range(380.0, 730.0))
      ->option_text("NM");
  command->add_option("--prefix", settings->prefix, "beginning of all names; else flare_, or lens_ of a direct image")
      ->option_text("NAME");
  command->footer(kExportExamples);
  command->callback([settings, &action] { action = [settings] { return run_polynomial_export(*settings); }; });
}

}  // namespace contrejour::cli
