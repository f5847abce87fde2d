// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cli/bench/tables.h"
#include "cli/flare_report.h"
#include "cli/machine.h"
#include "contrejour/expert/parameter.h"

namespace contrejour::cli {
namespace {

Json figure(double value) { return value > 0.0 ? Json(value) : Json(); }

Json decibels(const std::optional<double>& db) { return db && std::isfinite(*db) ? Json(*db) : Json(); }

// The paper's figure from the tables that vary tiles, merging or interpolation; null where it has none.
Json paper_variation(const BenchRow& row) {
  const TiledOptions defaults;
  const TiledOptions& t = row.request.tiled;
  const auto& system = *row.system;
  Json times;
  if (row.request.lights != 1) return times;
  if (t.dense_tile != defaults.dense_tile || t.coarse_tile != defaults.coarse_tile) {
    times["total"] = system.tiles_ms[(t.dense_tile == defaults.dense_tile ? 0U : 2U) + (t.coarse_tile == 0 ? 0U : 1U)];
  } else if (t.merge_steps != defaults.merge_steps || t.merge_threshold != defaults.merge_threshold) {
    times["total"] = figure(system.merging_ms[t.merge_steps == 0 ? 0 : 2]);
  } else {
    // The paper's order has the mean value second.
    constexpr std::size_t kColumn[] = {0, 2, 1, 3, 4};
    times["tile_traversal"] = system.traverse_ms[kColumn[static_cast<std::size_t>(t.interpolation)]];
  }
  return times;
}

Json paper_times(const BenchRow& row) {
  if (row.paper_if_any() == nullptr) return {};
  const PaperFigures& p = row.paper();
  if (row.request.method == "bundle") {
    return {{"total", p.bundle_total_ms}, {"ray_tracing", p.bundle_trace_ms}, {"rasterisation", p.bundle_raster_ms}};
  }
  if (row.request.method == "tiled" && !same(row.request, tiled_of(row.request.lights))) return paper_variation(row);
  return {{"total", p.tiled_total_ms},
          {"ray_tracing_and_coarse_tiles", p.tiled_trace_ms},
          {"dense_tiles", p.tiled_dense_ms},
          {"tile_traversal", p.tiled_traverse_ms}};
}

Json paper_counts(const ByMerging& counts) {
  return {{"no_merge", figure(counts[0])}, {"light_merge", figure(counts[1])}, {"heavy_merge", figure(counts[2])}};
}

void add_grid(Json& json, const GridOptions& grid) {
  json["grid"] = grid.rays;
  json["scale_grid"] = grid.scale;
}

// The options of the method, and those that all methods have.
Json settings_json(const BenchRow& row) {
  const FrameSettings& s = row.settings;
  Json json{{"lens", row.system->lens},
            {"width", s.frame.width},
            {"height", s.frame.height},
            {"wavelengths", s.wavelengths},
            {"runs", row.runs}};
  if (const auto* const adaptive = row.options.get_if<AdaptiveOptions>()) json["error"] = adaptive->error;
  if (const auto* const bundle = row.options.get_if<BundleOptions>()) add_grid(json, bundle->grid);
  if (const auto* const reference = row.options.get_if<ReferenceOptions>()) json["density"] = reference->density;
  if (const auto* const tiled = row.options.get_if<TiledOptions>()) {
    add_grid(json, tiled->grid);
    json["merge_steps"] = tiled->merge_steps;
    json["merge_threshold"] = tiled->merge_threshold;
    json["tile"] = tiled->dense_tile;
    json["coarse_tile"] = tiled->coarse_tile;
    json["interpolation"] = params::parameter("interpolation").choices[static_cast<std::size_t>(tiled->interpolation)];
  }
  return json;
}

Json row_json(const BenchRow& row) {
  const PaperFigures* paper = row.paper_if_any();
  return {{"system", row.system->name},
          {"f_number", row.f_number},
          {"lights", row.request.lights},
          {"method", row.statistics.method},
          {"device", row.statistics.device},
          {"settings", settings_json(row)},
          {"time_ms", times_json(row.statistics)},
          {"psnr_db", decibels(row.reference_db)},
          {"psnr_bundle_db", decibels(row.bundle_db)},
          {"psnr_unmerged_db", decibels(row.unmerged_db)},
          {"paper_ms", paper_times(row)},
          {"paper_psnr_db", paper ? Json(paper->tiled_psnr_db) : Json()},
          {"paper_primitives", paper ? paper_counts(paper->primitives) : Json()},
          {"paper_tile_indices", paper ? paper_counts(paper->indices) : Json()},
          {"rays", row.statistics.rays},
          {"surface_hits", row.statistics.surface_hits},
          {"primitives", row.statistics.primitives},
          {"primitives_merged", row.statistics.primitives_merged},
          {"tile_indices", row.statistics.tile_indices},
          {"primitive_bytes", row.statistics.primitive_bytes},
          {"tile_list_bytes", row.statistics.tile_list_bytes},
          {"ghosts_rendered", row.statistics.ghosts_rendered},
          {"peak_memory_bytes", row.statistics.peak_memory_bytes}};
}

Json target_json(const Target& target) {
  return {{"name", target.name},        {"system", target.system},
          {"lights", target.lights},    {"value", target.value},
          {"must", target.must},        {"aim", target.aim},
          {"unit", target.unit},        {"more_is_better", target.more_is_better},
          {"holds", holds_text(target)}};
}

}  // namespace

Json bench_json(const BenchRows& rows, const std::vector<Target>& targets) {
  Json list = Json::array();
  for (const BenchRow& row : rows.all()) list.push_back(row_json(row));
  Json target_list = Json::array();
  for (const Target& target : targets) target_list.push_back(target_json(target));
  return {{"machine", machine_json(this_machine())}, {"rows", list}, {"targets", target_list}};
}

std::string machine_text() {
  const Machine machine = this_machine();
  return fmt::format("{}, {} cores, {}, {}\n", machine.processor, machine.cores, machine.system, machine.compiler);
}

Result<void> BenchFile::open(const std::string& destination) {
  const auto file = outputs_.add(destination);
  if (!file) return tl::unexpected(file.error());
  file_ = *file;
  return {};
}

Result<void> BenchFile::write(const BenchRows& rows, const std::vector<Target>& targets) {
  if (file_ == nullptr) return {};
  if (const auto ok = file_->write(json_text(bench_json(rows, targets))); !ok) return ok;
  return outputs_.commit();
}

}  // namespace contrejour::cli
