// SPDX-License-Identifier: Apache-2.0
// contrejour bench device: how fast a device draws the papers' systems.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/bench/device_speed.h"
#include "cli/bench/report.h"
#include "cli/command.h"
#include "cli/console.h"
#include "cli/long_task.h"
#include "cli/options.h"
#include "cli/outputs.h"
#include "cli/text_table.h"

namespace contrejour::cli {
namespace {

struct DeviceOptions {
  std::string json;
  DeviceRun run{.method = "adaptive"};
  std::vector<std::string> systems;
  bool skips_comparison = false;
  params::Values values;
};

Result<std::vector<DeviceSpeed>> measure_all(const DeviceOptions& options) {
  std::vector<DeviceSpeed> all;
  for (const PaperSystem& system : paper_systems()) {
    if (!options.systems.empty() && std::ranges::find(options.systems, system.key) == options.systems.end()) continue;
    const LongTask task(std::string(system.name), options.values.integer("threads"));
    Context context = task.context();
    context.progress = {};
    auto speed = measure_device(system, options.run, options.values, context);
    if (!speed) return tl::unexpected(speed.error());
    all.push_back(std::move(*speed));
  }
  return all;
}

std::string or_dash(double value, int digits) { return value > 0.0 ? fmt::format("{:.{}f}", value, digits) : "-"; }

std::string in_flight_text(const DeviceSpeed& one) {
  std::string text;
  for (const double speed : one.frames_a_second) text += fmt::format("{}{:.1f}", text.empty() ? "" : " / ", speed);
  return text;
}

std::string speed_text(const std::vector<DeviceSpeed>& all) {
  TextTable table({"<system", "f/", "lights", "device ms", "frame ms", "RTX 3060 ms", "RTX 3060 / device", "dB", "rays",
                   "polygons", "frames/s"});
  for (const DeviceSpeed& one : all)
    table.add({one.system, fmt::format("{:g}", one.f_number), fmt::format("{}", one.lights), or_dash(one.device_ms, 3),
               fmt::format("{:.2f}", one.frame_ms), or_dash(one.paper_ms, 2),
               or_dash(one.device_ms > 0.0 ? one.paper_ms / one.device_ms : 0.0, 1),
               or_dash(one.psnr_db.value_or(0.0), 1), fmt::format("{}", one.last.rays),
               fmt::format("{}", one.last.primitives), in_flight_text(one)});
  return table.text();
}

std::string stages_text(const std::vector<DeviceSpeed>& all) {
  std::string text;
  for (const DeviceSpeed& one : all) {
    text += fmt::format("{}: ", one.system);
    for (const auto& [stage, ms] : one.stages_ms) text += fmt::format(" {} {:.3f}", stage, ms);
    text += "\n";
  }
  return text;
}

Json speed_json(const std::vector<DeviceSpeed>& all) {
  Json json = Json::array();
  for (const DeviceSpeed& one : all) {
    Json stages = Json::object();
    for (const auto& [stage, ms] : one.stages_ms) stages[stage] = ms;
    json.push_back({{"system", one.system},
                    {"f_number", one.f_number},
                    {"lights", one.lights},
                    {"frames", one.frames},
                    {"device", one.last.device},
                    {"device_ms", one.device_ms},
                    {"frame_ms", one.frame_ms},
                    {"frames_per_second", one.frames_a_second},
                    {"paper_ms", one.paper_ms},
                    {"psnr_db", one.psnr_db ? Json(*one.psnr_db) : Json()},
                    {"rays", one.last.rays},
                    {"polygons", one.last.primitives},
                    {"stages_ms", stages}});
  }
  return json;
}

Result<int> run_device(DeviceOptions options) {
  options.run.compares = !options.skips_comparison;
  Outputs outputs;
  const auto json = outputs.add(options.json);
  if (!json) return tl::unexpected(json.error());
  const auto all = measure_all(options);
  if (!all) return tl::unexpected(all.error());
  if (*json != nullptr) {
    if (const auto ok = (*json)->write(json_text(speed_json(*all))); !ok) return tl::unexpected(ok.error());
    if (const auto ok = outputs.commit(); !ok) return tl::unexpected(ok.error());
  }
  print(machine_text());
  if (!all->empty()) print(fmt::format("device: {}\n\n", all->front().last.device));
  print(speed_text(*all) + "\nmedians of the device's stages, ms:\n" + stages_text(*all));
  return kDone;
}

}  // namespace

void add_bench_device(CLI::App& bench, Action& action) {
  const auto options = std::make_shared<DeviceOptions>();
  CLI::App* command = bench.add_subcommand("device", "measure how fast a device draws the papers' lenses");
  add_output(*command, "--json", options->json, {".json"}, "write all figures to this file");
  add_number(*command, "--frames", options->run.frames, 1, 100000,
             "frames of each system, after 1.5 s of others that do not count");
  add_number(*command, "--lights", options->run.lights, 1, 10000, "lights of each frame");
  command->add_option("--method", options->run.method, "adaptive, tiled or bundle (default: adaptive)");
  command->add_flag("--no-comparison", options->skips_comparison, "do not compare the first frame with the CPU's");
  command->add_option("--systems", options->systems, "heliar, itoh, nikon, canon-135, canon-200 (default: all)")
      ->delimiter(',')
      ->option_text("LIST");
  add_parameters(*command, options->values, {"size", "error", "wavelengths", "threads"});
  command->footer(
      "The lights move from frame to frame, and pictures stay in the device's memory. \"device\" is the time by the\n"
      "device's own clock, \"frame\" the elapsed time, and \"RTX 3060\" the time of bodonyi2023's method on that GPU.\n"
      "\"frames/s\" is for one frame at a time and for two and three in flight, with all that the host does.\n"
      "\"dB\" is the first frame against the CPU's `adaptive` at --error 0.0001.\n"
      "CONTREJOUR_DEVICE chooses the device.\n\n"
      "Examples:\n  contrejour bench device\n  contrejour bench device --systems heliar,canon-135 --frames 1000\n"
      "  contrejour bench device --lights 100 --systems canon-135 --json speed.json");
  command->callback([&action, options] { action = [options] { return run_device(*options); }; });
}

}  // namespace contrejour::cli
