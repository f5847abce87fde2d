// SPDX-License-Identifier: Apache-2.0
// contrejour polynomial: fits a lens's ghosts with polynomials, and describes such a fit.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/lens_choice.h"
#include "cli/long_task.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/polynomial_direct.h"
#include "cli/text_table.h"
#include "contrejour/expert/polynomial_range.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

constexpr const char* kPolynomialFitExamples =
    "All ghosts are fitted for the whole field, all visible wavelengths and every f-number; coatings and build errors\n"
    "need a fit of their own, and so does each zoom and focus without --zoom-range or --focus-range. Where a ghost "
    "does\n"
    "not reach the accuracy, the file says that it must be traced.\n\n"
    "Examples:\n"
    "  contrejour polynomial fit heliar -o heliar.poly\n"
    "  contrejour polynomial fit canon-70-200 --focal 135 --half-field 12 -o canon.poly --json\n"
    "  contrejour polynomial fit nikon-80-200 --zoom-range 80,200 -o nikon.poly\n"
    "  contrejour polynomial fit planar-50 --focus-range 500,inf -o planar.poly\n"
    "  contrejour polynomial fit planar-50 --focus 2000 --direct -o planar-direct.poly";
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
  std::vector<double> zoom_mm, focus_mm;
  int max_order = PolynomialOptions{}.max_order, threads = 0;
  bool json = false, direct = false;
  params::Values values;
};

// A row of the table: one ghost.
struct PolynomialSummary {
  std::string ghost;
  int order = 0;
  std::size_t spans = 0;  // of a range
  std::size_t fitted = 0, traced = 0;  // zones
  double p95_px = 0.0, edge = 0.0, transmittance = 0.0;  // the worst of the fitted zones
  double flux = 0.0, traced_flux = 0.0;  // weighted by the zones' areas

  void add(const PolynomialZone& zone, double weight) {
    add(zone, weight, zone.field_high * zone.field_high - zone.field_low * zone.field_low);
  }
  // A zone of either kind.
  void add(const auto& zone, double weight, double area) {
    flux += weight * zone.flux_mm2 * area;
    if (zone.state == PolynomialZone::State::Traced) {
      ++traced;
      traced_flux += weight * zone.flux_mm2 * area;
    }
    if (zone.state != PolynomialZone::State::Fitted) return;
    ++fitted;
    order = std::max(order, zone.order);
    p95_px = std::max(p95_px, zone.accuracy.position_p95_px);
    edge = std::max(edge, zone.accuracy.edge_p95);
    transmittance = std::max(transmittance, zone.accuracy.transmittance_p95);
  }
};

// A fit of one state, or of a range: its values but the ghosts, and a summary of each ghost.
struct FitSummary {
  const LensPolynomials& common;
  double traced_flux = 0.0;
  std::string range;  // in words; empty for one state
  std::vector<PolynomialSummary> ghosts;
};

FitSummary fit_summary(const LensPolynomials& fit) {
  FitSummary summary{fit, traced_flux_fraction(fit), {}, {}};
  for (const GhostPolynomials& ghost : fit.ghosts) {
    PolynomialSummary& row = summary.ghosts.emplace_back(PolynomialSummary{.ghost = ghost_name(ghost.ghost)});
    for (const AsymmetricZone& zone : ghost.asymmetric) row.add(zone, 1.0, area_of(ghost, zone));
    if (!ghost.asymmetric.empty()) continue;
    for (const PolynomialZone& zone : ghost.zones) row.add(zone, 1.0);
  }
  return summary;
}

std::string range_text(const LensPolynomialRange& range) {
  const auto [first_mm, last_mm] = range.ends_mm;
  if (range.variable == PolynomialVariable::Zoom)
    return fmt::format("focal lengths from {:.1f} to {:.1f} mm", first_mm, last_mm);
  return fmt::format("objects from {:.0f} to {:.0f} mm", last_mm, first_mm);
}

FitSummary fit_summary(const LensPolynomialRange& range) {
  FitSummary summary{range.common, traced_flux_fraction(range), range_text(range), {}};
  for (const GhostRange& ghost : range.ghosts) {
    PolynomialSummary& row = summary.ghosts.emplace_back(PolynomialSummary{.ghost = ghost_name(ghost.ghost)});
    row.spans = ghost.spans.size();
    for (const PolynomialSpan& span : ghost.spans)
      for (const std::vector<PolynomialZone>& nodes : span.zones)
        for (const PolynomialZone& zone : nodes)
          row.add(zone, (span.high - span.low) / static_cast<double>(nodes.size()));
  }
  return summary;
}

Json polynomial_json(const FitSummary& fit, std::size_t bytes) {
  Json ghosts = Json::array();
  for (const PolynomialSummary& s : fit.ghosts) {
    ghosts.push_back({{"ghost", s.ghost},
                      {"order", s.order},
                      {"zones_fitted", s.fitted},
                      {"zones_traced", s.traced},
                      {"position_p95_px", s.p95_px},
                      {"edge_p95", s.edge},
                      {"transmittance_p95", s.transmittance},
                      {"traced_fraction", s.flux > 0.0 ? s.traced_flux / s.flux : 0.0}});
    if (s.spans > 0) ghosts.back()["spans"] = s.spans;
  }
  Json json{{"lens", fit.common.lens},
            {"fingerprint", fmt::format("{:016x}", fit.common.fingerprint)},
            {"bytes", bytes},
            {"half_field_deg", std::atan(fit.common.max_field) / params::kDegree_rad},
            {"stop_radius_mm", fit.common.stop_radius_mm},
            {"pixel_mm", fit.common.pixel_mm},
            {"traced_flux_fraction", fit.traced_flux},
            {"ghosts", ghosts}};
  if (!fit.range.empty()) json["range"] = fit.range;
  return json;
}

std::string polynomial_text(const FitSummary& fit, std::size_t bytes) {
  const bool is_range = !fit.range.empty();
  std::vector<std::string> heads{"<ghost", "order", "zones", "p95 px", "edge", "T %", "traced %"};
  if (is_range) heads.emplace_back("spans");
  TextTable table(heads);
  for (const PolynomialSummary& s : fit.ghosts) {
    const bool any = s.fitted > 0;
    std::vector<std::string> row{
        s.ghost,
        any ? fmt::format("{}", s.order) : "",
        fmt::format("{}", s.fitted + s.traced),
        any ? fmt::format("{:.4f}", s.p95_px) : "",
        any ? fmt::format("{:.5f}", s.edge) : "",
        any ? fmt::format("{:.3f}", 100.0 * s.transmittance) : "",
        s.flux > 0.0 ? fmt::format("{:.0f}", 100.0 * s.traced_flux / s.flux) : (s.traced > 0 ? "100" : "0")};
    if (is_range) row.push_back(fmt::format("{}", s.spans));
    table.add(row);
  }
  return fmt::format(
             "{}{}\n{} ghosts, half field {:.1f} degrees, {} bytes; {:.1f} per cent of the flux must be traced\n\n",
             fit.common.lens, is_range ? ": " + fit.range : "", fit.ghosts.size(),
             std::atan(fit.common.max_field) / params::kDegree_rad, bytes, 100.0 * fit.traced_flux) +
         table.text();
}

PolynomialOptions fit_options(const PolynomialFitSettings& options) {
  PolynomialOptions fit;
  fit.half_field_rad = options.half_field_deg * params::kDegree_rad;
  fit.max_order = options.max_order;
  fit.scope = params::ghost_scope(options.values);
  fit.reflections = params::reflections(options.values);
  return fit;
}

Result<int> write_fit(const PolynomialFitSettings& options, const std::string& bytes, const FitSummary& summary) {
  Outputs outputs;
  const auto file = outputs.add(options.output);
  if (!file) return tl::unexpected(file.error());
  if (const auto written = (*file)->write(bytes); !written) return tl::unexpected(written.error());
  if (const auto done = outputs.commit(); !done) return tl::unexpected(done.error());
  if (options.json)
    print_json(polynomial_json(summary, bytes.size()));
  else
    print_summary(fmt::format("{}: {} ghosts, {} bytes; {:.1f} per cent of the flux must be traced\n", options.output,
                              summary.ghosts.size(), bytes.size(), 100.0 * summary.traced_flux));
  return kDone;
}

Result<int> run_polynomial_range_fit(const PolynomialFitSettings& options) {
  const auto lens = prescription_of(options.lens);
  if (!lens) return tl::unexpected(lens.error());
  const auto settings = params::lens_settings(options.values);
  if (!settings) return tl::unexpected(settings.error());
  const bool is_zoom = !options.zoom_mm.empty();
  const std::vector<double>& ends_mm = is_zoom ? options.zoom_mm : options.focus_mm;
  const PolynomialRangeOptions range{.variable = is_zoom ? PolynomialVariable::Zoom : PolynomialVariable::Focus,
                                     .from_mm = ends_mm[0],
                                     .to_mm = ends_mm[1],
                                     .fit = fit_options(options)};
  const auto fitted = [&] {
    const LongTask task("fitting", options.threads);
    return fit_polynomial_range(params::with_sensor(*lens, options.values), *settings, range, task.context());
  }();
  if (!fitted) return tl::unexpected(fitted.error());
  return write_fit(options, write_polynomial_range(*fitted), fit_summary(*fitted));
}

Result<int> run_polynomial_fit(const PolynomialFitSettings& options) {
  if (options.direct)
    return run_direct_fit({options.lens, options.output, options.max_order, options.threads, options.json},
                          options.values);
  if (!options.zoom_mm.empty() || !options.focus_mm.empty()) return run_polynomial_range_fit(options);
  const auto lens = open_lens(options.lens, options.values);
  if (!lens) return tl::unexpected(lens.error());
  const auto fitted = [&] {
    const LongTask task("fitting", options.threads);
    return fit_polynomials(*lens, fit_options(options), task.context());
  }();
  if (!fitted) return tl::unexpected(fitted.error());
  return write_fit(options, write_polynomials(*fitted), fit_summary(*fitted));
}

Result<int> run_polynomial_info(const std::string& file, bool json) {
  if (is_direct_polynomial_file(file)) return run_direct_info(file, json);
  const auto polynomials = read_any_polynomial_file(file);
  if (!polynomials) return tl::unexpected(polynomials.error());
  std::error_code ignored;  // it was read
  const auto bytes = static_cast<std::size_t>(std::filesystem::file_size(file, ignored));
  const FitSummary summary = std::visit([](const auto& fit) { return fit_summary(fit); }, *polynomials);
  if (json)
    print_json(polynomial_json(summary, bytes));
  else
    print(polynomial_text(summary, bytes));
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
  CLI::Option* const zoom =
      command
          ->add_option("--zoom-range", options->zoom_mm, "one fit for all focal lengths between two, mm, at one focus")
          ->delimiter(',')
          ->expected(2)
          ->option_text("MM,MM");
  CLI::Option* const focus =
      command
          ->add_option("--focus-range", options->focus_mm,
                       "one fit for all distances of the object between two, mm, at one focal length; inf: infinity")
          ->delimiter(',')
          ->expected(2)
          ->option_text("MM,MM")
          ->excludes(zoom);
  command
      ->add_flag("--direct", options->direct,
                 "fit the direct image in place of the ghosts: camera rays, for path tracers and bokeh")
      ->excludes(zoom)
      ->excludes(focus);
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
  CLI::App* polynomial = app.add_subcommand(
      "polynomial", "fit, describe and export polynomials of a lens's ghosts and of its camera rays");
  polynomial->require_subcommand(1);
  polynomial->footer(
      "Examples:\n"
      "  contrejour polynomial fit heliar -o heliar.poly\n"
      "  contrejour polynomial info heliar.poly");
  add_polynomial_fit(*polynomial, action);
  add_polynomial_info(*polynomial, action);
  add_polynomial_at(*polynomial, action);
  add_polynomial_export(*polynomial, action);
}

}  // namespace contrejour::cli
