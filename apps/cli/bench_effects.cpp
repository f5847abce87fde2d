// SPDX-License-Identifier: Apache-2.0
// contrejour bench effects: measures the costs of all effects but ghosts, and compares them with targets.
#include <memory>
#include <string>

#include "cli/bench/effects.h"
#include "cli/bench/report.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/long_task.h"
#include "cli/options.h"

namespace contrejour::cli {
namespace {

struct EffectsOptions {
  std::string json;
  int runs = 3;
  params::Values values;
};

Result<std::vector<Target>> measure_effects(const EffectsOptions& options) {
  const LongTask task("effects", options.values.integer("threads"));
  auto scene = effect_scene(options.values, options.runs);
  if (!scene) return tl::unexpected(scene.error());
  scene->context.cancel = task.context().cancel;
  std::vector<Target> all;
  for (const MeasureEffect measure : effects()) {
    const auto rows = measure(*scene);
    if (!rows) return tl::unexpected(rows.error());
    all.insert(all.end(), rows->begin(), rows->end());
  }
  return all;
}

Result<int> run_effects(const EffectsOptions& options) {
  BenchFile json;
  if (const auto ok = json.open(options.json); !ok) return tl::unexpected(ok.error());
  const auto targets = measure_effects(options);
  if (!targets) return tl::unexpected(targets.error());
  if (const auto ok = json.write(BenchRows(), *targets); !ok) return tl::unexpected(ok.error());
  print(machine_text());
  print("\n" + targets_text(*targets));
  return kDone;
}

}  // namespace

void add_bench_effects(CLI::App& bench, Action& action) {
  const auto options = std::make_shared<EffectsOptions>();
  CLI::App* command = bench.add_subcommand(
      "effects", "measure starbursts, dirt, extended lights, many lights and layers, compared with their targets");
  add_output(*command, "--json", options->json, {".json"}, "write the targets to this file");
  add_number(*command, "--runs", options->runs, 1, 1000, "number of runs, of which the fastest counts");
  add_parameters(*command, options->values, {"size", "threads"});
  command->footer(
      "The lens is planar-50 at f/8 with 7 blades and one light. The sun is also compared with a point in other\n"
      "lenses, and many lights with one in the Heliar at 64x36. Targets in ms apply to two cores.\n\n"
      "Examples:\n"
      "  contrejour bench effects --threads 2\n"
      "  contrejour bench effects --runs 10 --json effects.json");
  command->callback([options, &action] { action = [options] { return run_effects(*options); }; });
}

}  // namespace contrejour::cli
