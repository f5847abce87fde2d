// SPDX-License-Identifier: Apache-2.0
// contrejour bench polynomial: measures the published polynomial fits on the rays that they were published with.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/bench/polynomial_fits.h"
#include "cli/bench/polynomial_lenses.h"
#include "cli/bench/polynomial_pictures.h"
#include "cli/bench/report.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/long_task.h"
#include "cli/options.h"
#include "cli/outputs.h"

namespace contrejour::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBenchPolynomialExamples =
    "The tables and plots of sabatschus2022 5.3 on its own rays, with its figures beside ours, then polynomials of "
    "few\n"
    "terms in zones of the field (2025). Without --full, annealing as published does 500 iterations, and fewer ghosts\n"
    "and zones are fitted. --pictures draws the causes of the thesis's wrong picture one by one, --density compares\n"
    "splatted points with adaptive cells. The tables lenses and lens-pictures, which must be named, are of our fits "
    "of\n"
    "the lenses of bodonyi2023, next to what they must reach; pictures of the reference take minutes each.\n\n"
    "Examples:\n"
    "  contrejour bench polynomial\n"
    "  contrejour bench polynomial --full --json fits.json --csv fits.csv --plots plots\n"
    "  contrejour bench polynomial --tables algorithms,annealing\n"
    "  contrejour bench polynomial --tables none --pictures pictures --density\n"
    "  contrejour bench polynomial --tables lenses,lens-pictures --cache ~/flares";

struct BenchPolynomialOptions {
  PolynomialBenchOptions fits;
  PolynomialPictureOptions pictures;
  PolynomialLensOptions lenses;
  std::string json, csv, plots;
  bool density = false;
  int seed = 1, threads = 0;
};

Result<void> make_folder(const std::string& folder) {
  if (folder.empty()) return {};
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) return failure(ErrorCode::Io, "the folder cannot be created: " + failed.message(), {folder});
  return {};
}

Result<void> write_files(const BenchPolynomialOptions& options, const PolynomialFits& fits,
                         const PolynomialLenses& lenses, OutputFile* json, OutputFile* csv, Outputs& outputs) {
  if (json != nullptr) {
    Json all = polynomial_fits_json(fits);
    all["lenses"] = polynomial_lenses_json(lenses);
    if (const auto ok = json->write(json_text(all)); !ok) return ok;
  }
  if (csv != nullptr)
    if (const auto ok = csv->write(polynomial_fits_csv(fits)); !ok) return ok;
  if (!options.plots.empty()) {
    for (const PolynomialPlot& plot : polynomial_plots(fits)) {
      const auto file = outputs.add((fs::path(options.plots) / (plot.name + ".svg")).string());
      if (!file) return tl::unexpected(file.error());
      if (const auto ok = (*file)->write(plot.svg); !ok) return ok;
    }
  }
  return outputs.commit();
}

// Whether a table is named; removes it from the list, in which something remains.
bool take_table(std::vector<std::string>& tables, const char* name) {
  if (std::erase(tables, name) == 0) return false;
  if (tables.empty()) tables.emplace_back("none");
  return true;
}

Result<int> run_bench_polynomial(BenchPolynomialOptions options) {
  options.lenses.fits = take_table(options.fits.tables, kLensFitsTable);
  options.lenses.pictures = take_table(options.fits.tables, kLensPicturesTable);
  if (!options.lenses.values.given("size"))
    if (const auto ok = options.lenses.values.set("size", "640x360"); !ok) return tl::unexpected(ok.error());
  options.fits.seed = static_cast<std::uint64_t>(options.seed);
  options.pictures.full = options.fits.full;
  Outputs outputs;
  const auto json = outputs.add(options.json), csv = outputs.add(options.csv);
  if (!json) return tl::unexpected(json.error());
  if (!csv) return tl::unexpected(csv.error());
  for (const std::string& folder : {options.plots, options.pictures.folder})
    if (const auto ok = make_folder(folder); !ok) return tl::unexpected(ok.error());
  const LongTask task("fitting", options.threads);
  const auto fits = measure_polynomial_fits(options.fits, task.context());
  if (!fits) return tl::unexpected(fits.error());
  const auto lenses = measure_polynomial_lenses(options.lenses, task.context());
  if (!lenses) return tl::unexpected(lenses.error());
  if (const auto ok = write_files(options, *fits, *lenses, *json, *csv, outputs); !ok)
    return tl::unexpected(ok.error());
  std::string text = machine_text() + "\n" + polynomial_fits_text(*fits) + polynomial_lenses_text(*lenses);
  if (!options.pictures.folder.empty()) {
    const auto pictures = draw_polynomial_pictures(options.pictures, task.context());
    if (!pictures) return tl::unexpected(pictures.error());
    text += *pictures;
  }
  if (options.density) {
    const auto density = compare_density(options.pictures, task.context());
    if (!density) return tl::unexpected(density.error());
    text += *density;
  }
  print(text);
  return kDone;
}

}  // namespace

void add_bench_polynomial(CLI::App& bench, Action& action) {
  const auto options = std::make_shared<BenchPolynomialOptions>();
  CLI::App* command =
      bench.add_subcommand("polynomial", "measure the published polynomial fits and draw what goes wrong with them");
  std::set<std::string> tables(published_fit_tables().begin(), published_fit_tables().end());
  tables.insert({"none", kLensFitsTable, kLensPicturesTable});
  std::set<std::string> systems;
  for (const PaperSystem& system : paper_systems()) systems.emplace(system.key);
  command
      ->add_option("--tables", options->fits.tables,
                   "dense, algorithms, annealing, variation, unfitted, zones (default: these); lenses, lens-pictures; "
                   "none")
      ->option_text("LIST")
      ->delimiter(',')
      ->check(CLI::IsMember(tables));
  command->add_flag("--full", options->fits.full,
                    "use the published numbers of samples and iterations: several minutes");
  command->add_option("--lens", options->fits.lens, "the lens of the zones")
      ->option_text("LENS")
      ->capture_default_str();
  command
      ->add_option("--systems", options->lenses.systems,
                   "lenses of lenses and lens-pictures: heliar, itoh, nikon, canon-135, canon-200 (default: all)")
      ->option_text("LIST")
      ->delimiter(',')
      ->check(CLI::IsMember(systems));
  command->add_option("--cache", options->lenses.cache, "keep the reference's pictures of lens-pictures in this folder")
      ->option_text("FOLDER");
  add_output(*command, "--json", options->json, {".json"}, "write all figures and curves to this file");
  add_output(*command, "--csv", options->csv, {".csv"}, "write the figures of published fits to this file");
  command->add_option("--plots", options->plots, "write the plots to this folder, as SVG")->option_text("FOLDER");
  command->add_option("--pictures", options->pictures.folder, "draw the faults to this folder, as PNG and EXR")
      ->option_text("FOLDER");
  command->add_flag("--density", options->density, "compare splatted random points with cells");
  add_number(*command, "--seed", options->seed, 0, 1000000, "seed of samples and searches");
  add_number(*command, "--threads", options->threads, 0, 4096, "number of threads; 0: one per core");
  add_parameters(*command, options->lenses.values, {"size"});
  command->footer(kBenchPolynomialExamples);
  command->callback([options, &action] { action = [options] { return run_bench_polynomial(*options); }; });
}

}  // namespace contrejour::cli
