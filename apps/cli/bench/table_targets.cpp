// SPDX-License-Identifier: Apache-2.0
// The targets of adaptive, and the ratios that it reaches in this run.
#include <algorithm>

#include <fmt/format.h>

#include "cli/bench/tables.h"
#include "cli/flare_report.h"
#include "cli/text_table.h"

namespace contrejour::cli {
namespace {

constexpr int kManyLights = 100;
constexpr int kManyWavelengths = 16;
constexpr int kScale = 2;  // 4K over 1080p

BenchRequest many_wavelengths() { return {.method = "adaptive", .variant = {.wavelengths = kManyWavelengths}}; }
BenchRequest large_frame() { return {.method = "adaptive", .variant = {.scale = kScale}}; }

std::vector<BenchRequest> targets_requests(const std::vector<std::string>&) {
  return {adaptive_of(1), tiled_of(1),        bundle_of(1),  adaptive_of(2),          tiled_of(2),
          bundle_of(2),   many_wavelengths(), large_frame(), adaptive_of(kManyLights)};
}

// Adaptive's PSNR against the reference: at least that of tiled.
std::optional<Target> quality(const BenchRow& adaptive, const BenchRow& tiled) {
  if (!adaptive.reference_db || !tiled.reference_db) return std::nullopt;
  return Target{.name = "PSNR of adaptive",
                .system = std::string(adaptive.system->name),
                .lights = adaptive.request.lights,
                .value = *adaptive.reference_db,
                .must = std::max(50.0, *tiled.reference_db),
                .aim = 55.0,
                .more_is_better = true,
                .unit = "dB",
                .note = fmt::format("tiled {}", db_text(tiled.reference_db))};
}

// The time over a lower limit: its surface hits at the measured peak rate, and one pass over the frame.
Target over_floor(const BenchRow& adaptive, const BenchProbe& probe) {
  const auto hits = static_cast<double>(adaptive.statistics.surface_hits);
  const double hits_ms = hits / probe.peak_hits_per_ms;
  return {.name = "adaptive / floor",
          .system = std::string(adaptive.system->name),
          .lights = adaptive.request.lights,
          .value = total_ms(adaptive.statistics) / (hits_ms + probe.frame_pass_ms),
          .must = 4.0,
          .aim = 2.0,
          .note = fmt::format("{:.2f} M hits at {:.0f} M/s {:.2f} ms, frame {:.2f} ms", hits * 1e-6,
                              probe.peak_hits_per_ms * 1e-3, hits_ms, probe.frame_pass_ms)};
}

// The time of a larger task over that of the baseline, both with adaptive, divided by `ratio`.
Target growth(std::string name, const BenchRow& more, const BenchRow& baseline, double ratio, double must, double aim) {
  const double more_ms = total_ms(more.statistics);
  const double baseline_ms = total_ms(baseline.statistics);
  return {.name = std::move(name),
          .system = std::string(more.system->name),
          .lights = more.request.lights,
          .value = more_ms / baseline_ms / ratio,
          .must = must,
          .aim = aim,
          .note = fmt::format("{:.1f} ms, {:.1f} ms", more_ms, baseline_ms)};
}

Target preparation(const PaperSystem& system, const BenchProbe& probe) {
  return {.name = "preparing a new lens",
          .system = std::string(system.name),
          .value = probe.prepare_ms,
          .must = 1000.0,
          .aim = 50.0,
          .unit = "ms"};
}

Target memory(const PaperSystem& system, const BenchProbe& probe) {
  return {.name = "peak memory",
          .system = std::string(system.name),
          .lights = 2,
          .value = static_cast<double>(probe.peak_memory_bytes) * 1e-6,
          .must = 300.0,
          .aim = 100.0,
          .unit = "MB"};
}

// Adds the targets of one system with the paper's lights.
void add_of_paper(const BenchRows& rows, const PaperSystem& system, int lights, std::vector<Target>& list) {
  const BenchRow& adaptive = rows.at(system, adaptive_of(lights));
  const BenchRow& tiled = rows.at(system, tiled_of(lights));
  list.push_back(speed_target(rows.at(system, bundle_of(lights)), adaptive, 20.0, 100.0));
  list.push_back(speed_target(tiled, adaptive, 10.0, 50.0));
  if (const auto target = quality(adaptive, tiled)) list.push_back(*target);
  list.push_back(over_floor(adaptive, rows.probe_of(system)));
}

void add_of_growth(const BenchRows& rows, const PaperSystem& system, std::vector<Target>& list) {
  const BenchRow& baseline = rows.at(system, adaptive_of(1));
  const BenchRow& coloured = rows.at(system, many_wavelengths());
  const BenchRow& large = rows.at(system, large_frame());
  list.push_back(growth(fmt::format("{} wavelengths / {}", kManyWavelengths, baseline.settings.wavelengths), coloured,
                        baseline, 1.0, 2.0, 1.3));
  list.push_back(growth(fmt::format("{} lights / 1, per light", kManyLights), rows.at(system, adaptive_of(kManyLights)),
                        baseline, kManyLights, 1.0, 0.5));
  list.push_back(growth(fmt::format("{}x{} / {}x{}", large.settings.frame.width, large.settings.frame.height,
                                    baseline.settings.frame.width, baseline.settings.frame.height),
                        large, baseline, 1.0, 4.0, 3.0));
}

std::vector<Target> measured_targets(const BenchRows& rows) {
  std::vector<Target> list;
  for (const PaperSystem* system : rows.systems()) {
    for (const int lights : {1, 2}) add_of_paper(rows, *system, lights, list);
    add_of_growth(rows, *system, list);
    const BenchProbe& probe = rows.probe_of(*system);
    list.push_back(preparation(*system, probe));
    if (probe.peak_memory_bytes > 0) list.push_back(memory(*system, probe));
  }
  // Sorts by target, then by system.
  std::vector<std::string> names;
  for (const Target& target : list) {
    if (std::find(names.begin(), names.end(), target.name) == names.end()) names.push_back(target.name);
  }
  const auto rank = [&](const Target& target) { return std::find(names.begin(), names.end(), target.name); };
  std::stable_sort(list.begin(), list.end(), [&](const Target& a, const Target& b) { return rank(a) < rank(b); });
  return list;
}

std::string times_text(const BenchRows& rows) {
  TextTable table({"lights", "<system", "f/", "adaptive ms", "RTX 3060 ms", "over it", "tiled ms", "bundle ms",
                   "adaptive dB of reference", "tiled dB"});
  for (const int lights : {1, 2}) {
    for (const PaperSystem* system : rows.systems()) {
      const BenchRow& adaptive = rows.at(*system, adaptive_of(lights));
      const BenchRow& tiled = rows.at(*system, tiled_of(lights));
      const double ms = total_ms(adaptive.statistics);
      const double paper_ms = adaptive.paper().tiled_total_ms;
      table.add({fmt::format("{}", lights), std::string(system->name), fmt::format("{:g}", adaptive.f_number),
                 ms_text(ms), paper_text(paper_ms, 2), fmt::format("{:.1f}", ms / paper_ms),
                 ms_text(total_ms(tiled.statistics)), ms_text(total_ms(rows.at(*system, bundle_of(lights)).statistics)),
                 db_text(adaptive.reference_db), db_text(tiled.reference_db)});
    }
  }
  return table.text();
}

std::string times_and_targets(const BenchRows& rows, const std::vector<std::string>&) {
  return times_text(rows) + "\n" + targets_text(measured_targets(rows));
}

}  // namespace

const BenchTable kTargetsTable{
    "targets",
    "Targets of adaptive, all measured in this run: with its times next to the paper's totals on a GeForce RTX 3060",
    targets_requests,
    times_and_targets,
    measured_targets,
    true};

}  // namespace contrejour::cli
