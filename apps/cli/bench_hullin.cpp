// SPDX-License-Identifier: Apache-2.0
// contrejour bench hullin: reproduces figures of hullin2011 and measures their times.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/bench/hullin.h"
#include "cli/bench/report.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "contrejour/expert/preview_exposure.h"
#include "contrejour/image_io.h"

namespace contrejour::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBenchHullinExamples =
    "The method `bundle` is the paper's. Its times are those of a GeForce GTX 285 (figure 17) and a GTX 580 (19).\n"
    "The exact coverage of pixels takes the place of the paper's supersampling. The reference renderer of figure 19\n"
    "takes minutes at full size.\n\n"
    "Examples:\n"
    "  contrejour bench hullin\n"
    "  contrejour bench hullin --figures 17,grids --size 480x270\n"
    "  contrejour bench hullin --figures 15 --pictures figure15 --json figure15.json";

struct HullinOptions {
  std::vector<std::string> figures, lenses;
  std::string pictures, json;
  HullinRunning running;
  params::Values values;
};

// Writes an EXR for measurements and a PNG as a preview.
Result<void> write_pictures(const fs::path& folder, const std::string& name, const Image& image,
                            const params::Values& values) {
  if (auto ok = write_exr(folder / (name + ".exr"), image); !ok) return ok;
  return write_preview_png(folder / (name + ".png"), image,
                           params::preview_settings(values, image, params::DefaultExposure::Automatic));
}

bool is_selected(const std::vector<std::string>& selected, std::string_view name) {
  return selected.empty() || std::ranges::find(selected, name) != selected.end();
}

Result<int> run_hullin(const HullinOptions& options) {
  Outputs outputs;
  const auto json = outputs.add(options.json);
  if (!json) return tl::unexpected(json.error());
  HullinRunning running = options.running;
  running.threads = options.values.integer("threads");
  if (!options.pictures.empty()) {
    std::error_code failed;
    fs::create_directories(options.pictures, failed);
    if (failed) return failure(ErrorCode::Io, "the folder cannot be created: " + failed.message(), {options.pictures});
    running.show = [&](const std::string& name, const Image& image) {
      return write_pictures(options.pictures, name, image, options.values);
    };
  }
  std::vector<HullinRow> all;
  std::string text = machine_text();
  for (const HullinFigure& figure : hullin_figures()) {
    if (!is_selected(options.figures, figure.key)) continue;
    std::vector<HullinRow> rows;
    for (const HullinSystem& system : figure.systems) {
      if (!is_selected(options.lenses, system.lens)) continue;
      const auto more = figure.measure(system, options.values, running);
      if (!more) return tl::unexpected(more.error());
      rows.insert(rows.end(), more->begin(), more->end());
    }
    text += "\n" + hullin_text(figure, rows);
    all.insert(all.end(), rows.begin(), rows.end());
  }
  if (*json != nullptr) {
    if (const auto ok = (*json)->write(json_text(hullin_json(all))); !ok) return tl::unexpected(ok.error());
    if (const auto ok = outputs.commit(); !ok) return tl::unexpected(ok.error());
  }
  print(text);
  return kDone;
}

}  // namespace

void add_bench_hullin(CLI::App& bench, Action& action) {
  const auto options = std::make_shared<HullinOptions>();
  CLI::App* command =
      bench.add_subcommand("hullin", "measure figures 15, 17 and 19 of hullin2011, and its coarse grids");
  std::set<std::string> figures, lenses;
  for (const HullinFigure& figure : hullin_figures()) {
    figures.emplace(figure.key);
    for (const HullinSystem& system : figure.systems) lenses.emplace(system.lens);
  }
  command->add_option("--figures", options->figures, "the figures to measure: 15, 17, 19, grids (default: all)")
      ->option_text("LIST")
      ->delimiter(',')
      ->check(CLI::IsMember(figures));
  command->add_option("--lenses", options->lenses, "measure only these lenses")
      ->option_text("LIST")
      ->delimiter(',')
      ->check(CLI::IsMember(lenses));
  command->add_option("--pictures", options->pictures, "write every picture to this folder, as EXR and as PNG")
      ->option_text("FOLDER");
  add_output(*command, "--json", options->json, {".json"}, "write the figures to this file");
  add_number(*command, "--runs", options->running.runs, 1, 1000, "number of runs, of which the fastest counts");
  add_parameters(*command, options->values, {"size", "grid", "density", "exposure", "threads"});
  command->footer(kBenchHullinExamples);
  command->callback([options, &action] { action = [options] { return run_hullin(*options); }; });
}

}  // namespace contrejour::cli
