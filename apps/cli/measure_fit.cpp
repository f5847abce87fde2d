// SPDX-License-Identifier: Apache-2.0
// contrejour measure fit: merged stations of a sweep -> a flare file, with a report.
#include "cli/measure_fit.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/console.h"
#include "cli/fit_report.h"
#include "cli/lens_choice.h"
#include "cli/long_task.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "contrejour/expert/flare_source.h"
#include "contrejour/expert/learn_lens.h"
#include "contrejour/expert/merged_sweep.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

constexpr const char* kFitExamples =
    "FOLDER is what `contrejour measure merge` wrote. Ghosts are found in the pictures alone, unless --lens names the\n"
    "lens. Each fifth station is held out (--held-out): it decides how many coefficients the curves have, and says "
    "what\n"
    "the flare is worth at angles that it was not fitted to. docs/measure.md says how far the figures can be "
    "trusted.\n\n"
    "Examples:\n"
    "  contrejour measure fit merged -o mine.flare.toml --report mine.html\n"
    "  contrejour measure fit merged -o mine.flare.toml --f-number 1.4 --iso 100 --time 1 --json\n"
    "  contrejour measure fit merged -o mine.flare.toml --compare-walch costs.svg\n"
    "  contrejour measure fit merged -o mine.flare.toml --lens planar-50 -f 4";

constexpr int kReportPictures = 7;
constexpr int kWidestFitted = 2000;

std::string name_of_output(const std::string& output) {
  const std::string file = std::filesystem::path(output).filename().string();
  constexpr std::string_view kEnding = ".flare.toml";
  return file.size() > kEnding.size() ? file.substr(0, file.size() - kEnding.size()) : file;
}

// The exposure of equation 2 needs all three numbers.
Result<std::optional<CaptureExposure>> given_exposure(const CaptureExposure& given) {
  const bool any = given.f_number > 0.0 || given.iso > 0.0 || given.time_s > 0.0;
  if (!any) return std::optional<CaptureExposure>();
  if (given.f_number > 0.0 && given.iso > 0.0 && given.time_s > 0.0) return std::optional(given);
  return invalid_argument(
      "the exposure of the photographs needs --f-number, --iso and --time together, or none of them");
}

// The ghosts of the lens that is named, from which the fit starts; none without a lens.
Result<std::vector<FoundGhost>> starts_of(const FitRequest& request, const MergedSweep& merged,
                                          const Context& context) {
  if (request.lens.empty()) return std::vector<FoundGhost>();
  const auto prescription = prescription_of(request.lens);
  if (!prescription) return tl::unexpected(prescription.error());
  const auto lens = params::lens_of(*prescription, request.lens_values);
  if (!lens) return tl::unexpected(lens.error());
  print_warnings(lens->warnings);
  double largest_rad = 0.0;
  for (const double angle : merged.angles_rad) largest_rad = std::max(largest_rad, std::abs(angle));
  return discs_of_lens(*lens, largest_rad, request.fit.max_ghosts, context);
}

Result<FitResult> fitted(const FitRequest& request, const MergedSweep& merged, const SweepGeometry& geometry) {
  const LongTask task("fitting", request.threads);
  const auto start = std::chrono::steady_clock::now();
  const FlareSweep sweep = merged.sweep();
  const auto starts = starts_of(request, merged, {request.threads, task.context().cancel, {}});
  if (!starts) return tl::unexpected(starts.error());
  FlareFitOptions options = request.fit;
  options.starts = *starts;
  auto fit = fit_flare(sweep, geometry, options, task.context());
  if (!fit) return tl::unexpected(fit.error());
  FitResult result;
  result.outcome = {request.name.empty() ? name_of_output(request.output) : request.name, geometry, std::move(*fit),
                    std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()};
  const FittedFlare& found = result.outcome.fit;
  if (!request.with_comparison || found.found.empty()) return result;
  auto comparison =
      compare_with_walch(sweep, geometry, found.found, found.centre_px, request.comparison, task.context());
  if (!comparison) return tl::unexpected(comparison.error());
  result.comparison = std::move(*comparison);
  return result;
}

Result<void> write_comparison(OutputFile& file, const std::string& name, const FitComparison& comparison) {
  return file.write(lower_extension(name) == ".csv" ? comparison_csv(comparison) : comparison_chart(comparison));
}

Result<void> write_fit(const FitRequest& request, const FitResult& result) {
  Outputs outputs;
  OutputFile *flare = nullptr, *report = nullptr, *csv = nullptr, *compare = nullptr;
  const std::string none, &compared = result.comparison ? request.compare : none;
  const std::pair<const std::string&, OutputFile*&> all[] = {
      {request.output, flare}, {request.report, report}, {request.csv, csv}, {compared, compare}};
  if (auto ok = outputs.add_all(all); !ok) return ok;
  Result<void> ok = flare->write(write_flare(result.outcome.fit.flare));
  if (ok && report) {
    const auto page = fit_report(result.outcome, result.comparison);
    ok = page ? report->write(*page) : Result<void>(tl::unexpected(page.error()));
  }
  if (ok && csv) ok = csv->write(stations_csv(result.outcome.fit));
  if (ok && compare) ok = write_comparison(*compare, compared, *result.comparison);
  return ok ? outputs.commit() : ok;
}

void print_fit_warnings(const FitRequest& request, const MergedSweep& merged, const FitResult& result) {
  print_warnings(merged.warnings);
  print_warnings(result.outcome.fit.warnings);
  if (request.with_comparison && !result.comparison)
    print_warnings({"there is no ghost to compare fits by, so no comparison was made"});
}

Json comparison_json(const FitComparison& c) {
  return {{"our_evaluations", c.ours.back().image_evaluations},
          {"our_cost", c.ours.back().cost},
          {"walch_evaluations", c.walch.back().image_evaluations},
          {"walch_cost", c.walch.back().cost},
          {"evaluations_to_walch_cost", c.ours_to_walch_cost ? Json(*c.ours_to_walch_cost) : Json()}};
}

Result<int> run_fit(const FitRequest& request, bool json) {
  const auto result = fit_merged(request);
  if (!result) return tl::unexpected(result.error());
  if (json) {
    Json all = fit_json(result->outcome);
    if (result->comparison) all["comparison"] = comparison_json(*result->comparison);
    print_json(all);
  } else {
    print(fit_text(result->outcome));
  }
  return kDone;
}

void add_fit_numbers(CLI::App& command, FitRequest& request) {
  add_number(command, "--max-ghosts", request.fit.max_ghosts, 1, 200, "ghosts to look for by their edges");
  add_number(command, "--max-small-ghosts", request.fit.max_small_ghosts, 0, 200,
             "ghosts of a few pixels to look for besides");
  add_number(command, "--width", request.fit.max_width, 32, kWidestFitted, "pixels that pictures are reduced to");
  add_number(command, "--held-out", request.fit.held_out_every, 0, 1000,
             "leave every N-th station out of the fit, to test it; 0: fit all");
  command.add_option("--f-number", request.exposure.f_number, "of the photographs")
      ->check(CLI::Range(0.1, 1000.0))
      ->option_text("N");
  command.add_option("--iso", request.exposure.iso, "sensitivity of the photographs")
      ->check(CLI::Range(0.1, 1e7))
      ->option_text("N");
  command.add_option("--time", request.exposure.time_s, "exposure time whose brightness the flare shall have")
      ->check(CLI::Range(1e-6, 1e6))
      ->option_text("SECONDS");
  add_number(command, "--threads", request.threads, 0, 1024, "threads; 0: one for each core");
}

}  // namespace

Result<FitResult> fit_merged(FitRequest request) {
  const auto exposure = given_exposure(request.exposure);
  if (!exposure) return tl::unexpected(exposure.error());
  const auto merged = open_merged(request.folder);
  if (!merged) return tl::unexpected(merged.error());
  const auto geometry = geometry_of(*merged, request.folder);
  if (!geometry) return tl::unexpected(geometry.error());
  if (!request.report.empty()) request.fit.pictures = std::max(request.fit.pictures, kReportPictures);
  auto result = fitted(request, *merged, *geometry);
  if (!result) return tl::unexpected(result.error());
  MeasuredFlare& flare = result->outcome.fit.flare;
  flare.name = result->outcome.name;
  flare.source = fmt::format("fitted to {} stations of {}", merged->files.size(), request.folder);
  flare.exposure = *exposure;
  print_fit_warnings(request, *merged, *result);
  if (auto ok = write_fit(request, *result); !ok) return tl::unexpected(ok.error());
  return result;
}

void add_measure_fit(CLI::App& measure, Action& action) {
  const auto request = std::make_shared<FitRequest>();
  const auto json = std::make_shared<bool>(false);
  CLI::App* command = measure.add_subcommand("fit", "learn a flare from merged stations");
  command->add_option("FOLDER", request->folder, "the folder of merged stations")->required()->option_text(" ");
  add_output(*command, "-o,--output", request->output, {".toml"}, "the flare, NAME.flare.toml")
      ->required()
      ->check([](const std::string& file) {
        return is_measured_flare(file) ? std::string() : "a flare's file ends in .flare.toml";
      });
  add_output(*command, "--report", request->report, {".html"}, "a page with pictures and curves");
  add_output(*command, "--csv", request->csv, {".csv"}, "the figures of each station");
  add_output(*command, "--compare-walch", request->compare, {".svg", ".csv"},
             "costs of this fit and of walch2018's descent from the same start");
  command->add_option("--name", request->name, "the flare's name (default: the file's)")->option_text("NAME");
  command
      ->add_option("--lens", request->lens,
                   "a lens as it was photographed (-f, --focal, --focus): the fit starts from its ghosts")
      ->option_text("LENS");
  add_parameters(*command, request->lens_values, {"focal", "fnumber", "focus", "sensor"});
  add_fit_numbers(*command, *request);
  command->add_flag("--json", *json, "print JSON");
  command->footer(kFitExamples);
  command->callback([request, json, &action] {
    request->with_comparison = !request->compare.empty();
    action = [request, json] { return run_fit(*request, *json); };
  });
}

}  // namespace contrejour::cli
