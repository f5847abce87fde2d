// SPDX-License-Identifier: Apache-2.0
// contrejour bench tables: measures the systems of bodonyi2023 and compares them with the paper's figures.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/bench/probe.h"
#include "cli/bench/report.h"
#include "cli/bench/scene.h"
#include "cli/bench/tables.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/options.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

constexpr const char* kBenchTablesExamples =
    "The five lenses of the paper are rendered with one light and with two, at its f-numbers and grids (256 x 256,\n"
    "fewer rays for small ghosts; --grid). The paper's times are those of a GeForce RTX 3060. The lenses have their\n"
    "own coatings; --coating quarter-wave:620:1.38 gives the paper's. --cache keeps the pictures of --reference for\n"
    "later runs.\n\n"
    "Examples:\n"
    "  contrejour bench tables\n"
    "  contrejour bench tables --tables 2,4 --systems heliar,nikon --size 960x540 --json tables.json\n"
    "  contrejour bench tables --tables overview --methods bundle --reference --cache ~/flares\n"
    "  contrejour bench tables --tables targets --runs 5";

struct TablesOptions {
  std::string json, tables, methods, systems;
  BenchRunning running;
  params::Values values;
};

std::vector<std::string> words(const std::string& list) {
  std::vector<std::string> out;
  for (const std::string_view word : params::split(list, ',')) out.emplace_back(word);
  return out;
}

bool is_listed(std::string_view key, const std::string& list) {
  const auto keys = words(list);
  return list.empty() || std::find(keys.begin(), keys.end(), key) != keys.end();
}

// All methods but the reference, which takes hours.
std::vector<std::string> methods_of(const TablesOptions& options) {
  if (!options.methods.empty()) return words(options.methods);
  std::vector<std::string> list;
  for (const std::string_view method : render_methods()) {
    if (!method_traits(method)->is_slow) list.emplace_back(method);
  }
  return list;
}

std::vector<BenchRequest> requests_of(const TablesOptions& options) {
  std::vector<BenchRequest> all;
  for (const BenchTable& table : bench_tables()) {
    if (!is_listed(table.key, options.tables)) continue;
    for (const BenchRequest& request : table.requests(methods_of(options))) {
      const auto is_same = [&](const BenchRequest& other) { return same(request, other); };
      if (std::none_of(all.begin(), all.end(), is_same)) all.push_back(request);
    }
  }
  return all;
}

bool needs_probes(const TablesOptions& options) {
  const auto tables = bench_tables();
  return std::any_of(tables.begin(), tables.end(), [&](const BenchTable& table) {
    return table.needs_probes && is_listed(table.key, options.tables);
  });
}

// One request for each scene, in the order of the requests.
std::vector<BenchRequest> scenes_of(const std::vector<BenchRequest>& requests) {
  std::vector<BenchRequest> scenes;
  for (const BenchRequest& request : requests) {
    const auto is_same = [&](const BenchRequest& other) {
      return other.lights == request.lights && other.variant == request.variant;
    };
    if (std::none_of(scenes.begin(), scenes.end(), is_same)) scenes.push_back(request);
  }
  return scenes;
}

// Probes come first: peak memory would be meaningless once other methods have run. Measurements that form a ratio are
// made directly after each other.
Result<BenchRows> measure_tables(const TablesOptions& options) {
  BenchRows rows;
  BenchRunning running = options.running;
  running.threads = options.values.integer("threads");
  std::vector<const PaperSystem*> systems;
  for (const PaperSystem& system : paper_systems()) {
    if (is_listed(system.key, options.systems)) systems.push_back(&system);
  }
  if (needs_probes(options)) {
    if (const auto ok = probe(systems, options.values, running.threads, rows); !ok) return tl::unexpected(ok.error());
  }
  const auto requests = requests_of(options);
  std::vector visits{measure_scene};
  if (running.runs > 1) visits.push_back(measure_again);
  for (const PaperSystem* system : systems) {
    for (const auto& visit : visits) {
      for (const BenchRequest& of : scenes_of(requests)) {
        auto scene = bench_scene(*system, of.lights, of.variant, options.values);
        if (!scene) return tl::unexpected(scene.error());
        if (running.paper_ghosts) scene->settings.selection = papers_ghosts(*scene);
        if (const auto ok = visit(*scene, requests, running, rows); !ok) return tl::unexpected(ok.error());
      }
    }
  }
  return rows;
}

std::vector<Target> targets_of(const TablesOptions& options, const BenchRows& rows) {
  std::vector<Target> all;
  for (const BenchTable& table : bench_tables()) {
    if (table.targets == nullptr || !is_listed(table.key, options.tables)) continue;
    const auto its = table.targets(rows);
    all.insert(all.end(), its.begin(), its.end());
  }
  return all;
}

Result<int> run_tables(const TablesOptions& options) {
  BenchFile json;
  if (const auto ok = json.open(options.json); !ok) return tl::unexpected(ok.error());
  const auto rows = measure_tables(options);
  if (!rows) return tl::unexpected(rows.error());
  if (const auto ok = json.write(*rows, targets_of(options, *rows)); !ok) return tl::unexpected(ok.error());
  print(machine_text());
  for (const BenchTable& table : bench_tables()) {
    if (!is_listed(table.key, options.tables)) continue;
    print(fmt::format("\n{}\n{}", table.title, table.text(*rows, methods_of(options))));
  }
  return kDone;
}

std::string problem_with_methods(const std::string& list) {
  for (const std::string& word : words(list)) {
    const auto checked = params::check_value(params::parameter("method"), word);
    if (!checked) return checked.error().message;
  }
  return "";
}

// An error message if a word of the list is not a key of any of these; else an empty text.
template <class Things>
std::string problem_with_keys(const std::string& list, const Things& things, std::string_view what) {
  std::vector<std::string_view> known;
  for (const auto& thing : things) known.push_back(thing.key);
  for (const std::string& word : words(list)) {
    if (std::find(known.begin(), known.end(), word) == known.end()) {
      return fmt::format("\"{}\" is not a {}; give one of {}", word, what, fmt::join(known, ", "));
    }
  }
  return "";
}

std::string problem_with_systems(const std::string& list) { return problem_with_keys(list, paper_systems(), "system"); }
std::string problem_with_tables(const std::string& list) { return problem_with_keys(list, bench_tables(), "table"); }

}  // namespace

void add_bench_tables(CLI::App& bench, Action& action) {
  const auto options = std::make_shared<TablesOptions>();
  CLI::App* command = bench.add_subcommand("tables", "measure the lenses of bodonyi2023: times, counts, PSNR");
  add_output(*command, "--json", options->json, {".json"}, "write the rows to this file");
  command
      ->add_option(
          "--tables", options->tables,
          "the tables to print: overview, 2 to 8 as numbered in bodonyi2023, targets, full-aperture (default: all)")
      ->check(CLI::Validator(problem_with_tables, "", "tables"))
      ->option_text("LIST");
  command->add_option("--methods", options->methods, "the methods of the overview (default: all but reference)")
      ->check(CLI::Validator(problem_with_methods, "", "methods"))
      ->option_text("LIST");
  command
      ->add_option("--systems", options->systems,
                   "the lenses: heliar, itoh, nikon, canon-135, canon-200 (default: all)")
      ->check(CLI::Validator(problem_with_systems, "", "systems"))
      ->option_text("LIST");
  BenchRunning& running = options->running;
  add_number(*command, "--runs", running.runs, 1, 1000,
             "number of runs, of which the fastest counts; from two on, runs of milliseconds are repeated more often");
  command->add_flag("--paper-ghosts", running.paper_ghosts,
                    "only the paper's 11, 64, 139 and 304 ghosts, which exclude reflections at the last surface");
  command->add_flag("--reference", running.reference,
                    "also measure the PSNR relative to the reference renderer, which takes hours at full size");
  command->add_option("--cache", running.cache, "keep the pictures of the reference renderer in this folder")
      ->option_text("FOLDER");
  add_parameters(
      *command, options->values,
      {"size", "wavelengths", "grid", "scale-grid-sigma", "scale-grid-phi", "coating", "density", "threads"});
  command->footer(kBenchTablesExamples);
  command->callback([options, &action] { action = [options] { return run_tables(*options); }; });
}

}  // namespace contrejour::cli
