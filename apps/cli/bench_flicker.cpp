// SPDX-License-Identifier: Apache-2.0
// contrejour bench flicker: measures whether the flare of a light that moves slowly flickers.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/bench/flicker.h"
#include "cli/bench/report.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/long_task.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/text_table.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

constexpr const char* kUsualSize = "320x180";

struct FlickerOptions {
  std::string json;
  FlickerFrames frames;
  std::vector<std::string> systems, effects;
  params::Values values;
};

bool is_wanted(const std::vector<std::string>& wanted, std::string_view name) {
  return wanted.empty() || std::ranges::find(wanted, name) != wanted.end();
}

Result<std::vector<Flicker>> measure_all(const FlickerOptions& options) {
  std::vector<Flicker> all;
  for (const PaperSystem& system : paper_systems()) {
    for (const FlickerCase& effects : flicker_cases()) {
      if (!is_wanted(options.systems, system.key) || !is_wanted(options.effects, effects.name)) continue;
      const LongTask task(fmt::format("{}, {}", system.name, effects.name), options.values.integer("threads"));
      Context context = task.context();
      context.progress = {};
      auto flicker = measure_flicker(system, effects, options.frames, options.values, context);
      if (!flicker) return tl::unexpected(flicker.error());
      all.push_back(std::move(*flicker));
    }
  }
  return all;
}

std::string flicker_text(const std::vector<Flicker>& all, double error) {
  TextTable table({"<system", "<effects", "rendered", "fine", "difference", "of the error", "frame", "mean",
                   "unclipped", "pixel", "flux", "fine flux"});
  for (const Flicker& one : all)
    table.add({one.system, one.effects, fmt::format("{:.5f}", one.rendered), fmt::format("{:.5f}", one.fine),
               fmt::format("{:.5f}", one.difference), fmt::format("{:.2f}", one.difference / error),
               fmt::format("{}", one.worst_frame), fmt::format("{:.5f}", one.mean_difference),
               fmt::format("{:.5f}", one.unclipped), fmt::format("{:.3f}", one.pixel_difference),
               fmt::format("{:.5f}", one.flux), fmt::format("{:.5f}", one.fine_flux)});
  return table.text();
}

Json flicker_json(const std::vector<Flicker>& all, double error) {
  Json json = Json::array();
  for (const Flicker& one : all)
    json.push_back({{"system", one.system},
                    {"effects", one.effects},
                    {"frames", one.frames},
                    {"worst_frame", one.worst_frame},
                    {"error", error},
                    {"rendered", one.rendered},
                    {"fine", one.fine},
                    {"difference", one.difference},
                    {"mean_difference", one.mean_difference},
                    {"unclipped", one.unclipped},
                    {"pixel_difference", one.pixel_difference},
                    {"flux", one.flux},
                    {"fine_flux", one.fine_flux}});
  return json;
}

Result<int> run_flicker(FlickerOptions options) {
  if (!options.values.given("size")) static_cast<void>(options.values.set("size", kUsualSize));
  Outputs outputs;
  const auto json = outputs.add(options.json);
  if (!json) return tl::unexpected(json.error());
  const auto all = measure_all(options);
  if (!all) return tl::unexpected(all.error());
  const double error = params::adaptive_options(options.values).error;
  if (*json != nullptr) {
    if (const auto ok = (*json)->write(json_text(flicker_json(*all, error))); !ok) return tl::unexpected(ok.error());
    if (const auto ok = outputs.commit(); !ok) return tl::unexpected(ok.error());
  }
  print(machine_text());
  print("\n" + flicker_text(*all, error));
  const bool holds = std::ranges::all_of(*all, [&](const Flicker& one) { return one.difference <= error; });
  print(holds ? "\nno difference exceeds the error asked for\n" : "\na difference exceeds the error asked for\n");
  return holds ? kDone : kFailed;
}

}  // namespace

void add_bench_flicker(CLI::App& bench, Action& action) {
  const auto options = std::make_shared<FlickerOptions>();
  CLI::App* command =
      bench.add_subcommand("flicker", "measure whether the flare of a light that moves slowly flickers");
  add_output(*command, "--json", options->json, {".json"}, "write all figures to this file");
  add_number(*command, "--frames", options->frames.count, 3, 100000, "number of frames, a tenth of a pixel apart");
  add_number(*command, "--first", options->frames.first, 0, 100000, "frame of the shot to begin with");
  command->add_option("--systems", options->systems, "heliar, itoh, nikon, canon-135, canon-200 (default: all)")
      ->delimiter(',')
      ->option_text("LIST");
  command->add_option("--effects", options->effects, "none, ringing, size, dirt, all (default: each of them)")
      ->delimiter(',')
      ->option_text("LIST");
  add_parameters(*command, options->values, {"size", "error", "wavelengths", "ghosts", "threads"});
  command->footer(
      "The figures are second differences in time, f(t + 1) - 2 f(t) + f(t - 1): as the RMS over a frame's pixels,\n"
      "over the peak, the largest of all times; of a single sample; and of a channel's sum, over that sum. \"fine\" "
      "is\n"
      "the same of frames at --error 0.0001, and \"difference\" that of both frames' difference. Samples are clipped "
      "at\n"
      "the peak, as errors are measured; \"unclipped\" is the difference without that. The exit code is 1 if a\n"
      "difference exceeds the error asked for.\n\n"
      "The usual size is 320x180.\n\n"
      "Examples:\n"
      "  contrejour bench flicker --frames 40 --systems heliar\n"
      "  contrejour bench flicker --json flicker.json");
  command->callback([options, &action] { action = [options] { return run_flicker(*options); }; });
}

}  // namespace contrejour::cli
