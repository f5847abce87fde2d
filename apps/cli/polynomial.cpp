// SPDX-License-Identifier: Apache-2.0
// contrejour polynomial: fits a lens's ghosts with polynomials, and describes such a fit.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/lens_choice.h"
#include "cli/long_task.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/text_table.h"
#include "contrejour/expert/polynomial.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

constexpr const char* kPolynomialFitExamples =
    "All ghosts are fitted for the whole field, all visible wavelengths and every f-number; zoom, focus, coatings and\n"
    "build errors need a fit of their own. Where a ghost does not reach the accuracy, the file says that it must be\n"
    "traced.\n\n"
    "Examples:\n"
    "  contrejour polynomial fit heliar -o heliar.poly\n"
    "  contrejour polynomial fit canon-70-200 --focal 135 --half-field 12 -o canon.poly --json";
constexpr const char* kPolynomialInfoExamples =
    "order: the highest of the sensor's position. p95: 95 per cent of rays that were left out of the fit land nearer\n"
    "than this to their traced point, in pixels of the sensor's width / 1920. edge: the same at the stop and the "
    "rims,\n"
    "in radii. T: the same of the transmittance, relative to its largest value. traced: the fraction of the ghost's\n"
    "flux for which rays must be traced.\n\n"
    "Examples:\n"
    "  contrejour polynomial info heliar.poly\n"
    "  contrejour polynomial info canon.poly --json";

struct PolynomialFitSettings {
  std::string lens, output;
  double half_field_deg = 0.0;
  int max_order = PolynomialOptions{}.max_order, threads = 0;
  bool json = false;
  params::Values values;
};

// A row of the table: one ghost.
struct PolynomialSummary {
  std::string ghost;
  int order = 0;
  std::size_t fitted = 0, traced = 0;  // zones
  double p95_px = 0.0, edge = 0.0, transmittance = 0.0;  // the worst of the fitted zones
  double flux = 0.0, traced_flux = 0.0;  // weighted by the zones' areas
};

PolynomialSummary polynomial_summary(const GhostPolynomials& ghost) {
  PolynomialSummary s{.ghost = ghost_name(ghost.ghost)};
  for (const PolynomialZone& zone : ghost.zones) {
    const double flux = zone.flux_mm2 * (zone.field_high * zone.field_high - zone.field_low * zone.field_low);
    s.flux += flux;
    if (zone.state == PolynomialZone::State::Traced) {
      ++s.traced;
      s.traced_flux += flux;
    }
    if (zone.state != PolynomialZone::State::Fitted) continue;
    ++s.fitted;
    s.order = std::max(s.order, zone.order);
    s.p95_px = std::max(s.p95_px, zone.accuracy.position_p95_px);
    s.edge = std::max(s.edge, zone.accuracy.edge_p95);
    s.transmittance = std::max(s.transmittance, zone.accuracy.transmittance_p95);
  }
  return s;
}

Json polynomial_json(const LensPolynomials& polynomials, std::size_t bytes) {
  Json ghosts = Json::array();
  for (const GhostPolynomials& ghost : polynomials.ghosts) {
    const PolynomialSummary s = polynomial_summary(ghost);
    ghosts.push_back({{"ghost", s.ghost},
                      {"order", s.order},
                      {"zones_fitted", s.fitted},
                      {"zones_traced", s.traced},
                      {"position_p95_px", s.p95_px},
                      {"edge_p95", s.edge},
                      {"transmittance_p95", s.transmittance},
                      {"traced_fraction", s.flux > 0.0 ? s.traced_flux / s.flux : 0.0}});
  }
  return {{"lens", polynomials.lens},
          {"fingerprint", fmt::format("{:016x}", polynomials.fingerprint)},
          {"bytes", bytes},
          {"half_field_deg", std::atan(polynomials.max_field) / params::kDegree_rad},
          {"stop_radius_mm", polynomials.stop_radius_mm},
          {"pixel_mm", polynomials.pixel_mm},
          {"traced_flux_fraction", traced_flux_fraction(polynomials)},
          {"ghosts", ghosts}};
}

std::string polynomial_text(const LensPolynomials& polynomials, std::size_t bytes) {
  TextTable table({"<ghost", "order", "zones", "p95 px", "edge", "T %", "traced %"});
  for (const GhostPolynomials& ghost : polynomials.ghosts) {
    const PolynomialSummary s = polynomial_summary(ghost);
    const bool any = s.fitted > 0;
    table.add({s.ghost, any ? fmt::format("{}", s.order) : "", fmt::format("{}", ghost.zones.size()),
               any ? fmt::format("{:.4f}", s.p95_px) : "", any ? fmt::format("{:.5f}", s.edge) : "",
               any ? fmt::format("{:.3f}", 100.0 * s.transmittance) : "",
               s.flux > 0.0 ? fmt::format("{:.0f}", 100.0 * s.traced_flux / s.flux) : (s.traced > 0 ? "100" : "0")});
  }
  return fmt::format(
             "{}\n{} ghosts, half field {:.1f} degrees, {} bytes; {:.1f} per cent of the flux must be traced\n\n",
             polynomials.lens, polynomials.ghosts.size(), std::atan(polynomials.max_field) / params::kDegree_rad, bytes,
             100.0 * traced_flux_fraction(polynomials)) +
         table.text();
}

Result<int> run_polynomial_fit(const PolynomialFitSettings& options) {
  const auto lens = open_lens(options.lens, options.values);
  if (!lens) return tl::unexpected(lens.error());
  Outputs outputs;
  const auto file = outputs.add(options.output);
  if (!file) return tl::unexpected(file.error());
  PolynomialOptions fit;
  fit.half_field_rad = options.half_field_deg * params::kDegree_rad;
  fit.max_order = options.max_order;
  fit.scope = params::ghost_scope(options.values);
  fit.reflections = params::reflections(options.values);
  const auto fitted = [&] {
    const LongTask task("fitting", options.threads);
    return fit_polynomials(*lens, fit, task.context());
  }();
  if (!fitted) return tl::unexpected(fitted.error());
  const std::string bytes = write_polynomials(*fitted);
  if (const auto written = (*file)->write(bytes); !written) return tl::unexpected(written.error());
  if (const auto done = outputs.commit(); !done) return tl::unexpected(done.error());
  if (options.json)
    print_json(polynomial_json(*fitted, bytes.size()));
  else
    print_summary(fmt::format("{}: {} ghosts, {} bytes; {:.1f} per cent of the flux must be traced\n", options.output,
                              fitted->ghosts.size(), bytes.size(), 100.0 * traced_flux_fraction(*fitted)));
  return kDone;
}

Result<int> run_polynomial_info(const std::string& file, bool json) {
  const auto polynomials = read_polynomial_file(file);
  if (!polynomials) return tl::unexpected(polynomials.error());
  const std::size_t bytes = write_polynomials(*polynomials).size();
  if (json)
    print_json(polynomial_json(*polynomials, bytes));
  else
    print(polynomial_text(*polynomials, bytes));
  return kDone;
}

void add_polynomial_fit(CLI::App& polynomial, Action& action) {
  const auto options = std::make_shared<PolynomialFitSettings>();
  CLI::App* command = polynomial.add_subcommand("fit", "fit the ghosts of a lens with polynomials");
  add_lens_argument(*command, options->lens);
  add_output(*command, "-o,--output", options->output, {".poly"}, "the file to write")->required();
  command
      ->add_option("--half-field", options->half_field_deg,
                   "largest angle of a light to the axis, degrees; 0: that of the sensor's corner and a tenth more")
      ->check(CLI::Range(0.0, 85.0))
      ->capture_default_str();
  command->add_option("--max-order", options->max_order, "highest order, odd: 5 to 17")
      ->check(CLI::IsMember({5, 7, 9, 11, 13, 15, 17}))
      ->capture_default_str();
  add_number(*command, "--threads", options->threads, 0, 4096, "number of threads; 0: one per core");
  command->add_flag("--json", options->json, "print a report as JSON");
  add_lens_parameters(*command, options->values);
  for (const auto names : {std::span<const std::string_view>(kIris), {kGrating}, {kDirt}})
    hide_parameters(*command, names);
  add_parameters(*command, options->values, {"ghosts", "reflections"});
  command->footer(kPolynomialFitExamples);
  command->callback([options, &action] { action = [options] { return run_polynomial_fit(*options); }; });
}

void add_polynomial_info(CLI::App& polynomial, Action& action) {
  const auto file = std::make_shared<std::string>();
  const auto json = std::make_shared<bool>(false);
  CLI::App* command = polynomial.add_subcommand("info", "describe a file of polynomials");
  command->add_option("FILE", *file, "a file that `contrejour polynomial fit` wrote")->required()->option_text(" ");
  command->add_flag("--json", *json, "print JSON");
  command->footer(kPolynomialInfoExamples);
  command->callback([file, json, &action] { action = [file, json] { return run_polynomial_info(*file, *json); }; });
}

}  // namespace

void add_polynomial(CLI::App& app, Action& action) {
  CLI::App* polynomial = app.add_subcommand("polynomial", "fit, describe and export polynomials of a lens's ghosts");
  polynomial->require_subcommand(1);
  polynomial->footer(
      "Examples:\n"
      "  contrejour polynomial fit heliar -o heliar.poly\n"
      "  contrejour polynomial info heliar.poly");
  add_polynomial_fit(*polynomial, action);
  add_polynomial_info(*polynomial, action);
  add_polynomial_export(*polynomial, action);
}

}  // namespace contrejour::cli
