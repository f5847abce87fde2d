#include "cli/bench_report.h"

#include <cmath>

#include <fmt/format.h>

#include "cli/flare_report.h"
#include "cli/machine.h"
#include "cli/text_table.h"

namespace contrejour::cli {
namespace {

const PaperFigures& paper_of(const BenchRow& row) { return row.system->by_lights[row.lights - 1]; }

// The paper's time for the same method; its new, tiled one for any method it does not have.
double paper_total_ms(const BenchRow& row) {
  return row.statistics.method == "bundle" ? paper_of(row).bundle_total_ms : paper_of(row).tiled_total_ms;
}

Json paper_times(const BenchRow& row) {
  const PaperFigures& p = paper_of(row);
  if (row.statistics.method == "bundle") {
    return {{"total", p.bundle_total_ms}, {"ray_tracing", p.bundle_trace_ms}, {"rasterisation", p.bundle_raster_ms}};
  }
  return {{"total", p.tiled_total_ms},
          {"ray_tracing_and_coarse_tiles", p.tiled_trace_ms},
          {"dense_tiles", p.tiled_dense_ms},
          {"tile_traversal", p.tiled_traverse_ms}};
}

Json paper_counts(const PaperFigures& p) {
  return {{"no_merge", p.primitives},
          {"light_merge", p.primitives_light_merge},
          {"heavy_merge", p.primitives_heavy_merge > 0 ? Json(p.primitives_heavy_merge) : Json()}};
}

Json row_json(const BenchRow& row) {
  const RenderSettings& s = row.settings;
  const bool finite = row.psnr_db && std::isfinite(*row.psnr_db);
  return {{"system", row.system->name},
          {"f_number", row.system->f_number},
          {"lights", row.lights},
          {"method", row.statistics.method},
          {"device", row.statistics.device},
          {"settings", {{"lens", row.system->lens},
                        {"width", s.frame.width},
                        {"height", s.frame.height},
                        {"wavelengths", s.wavelengths},
                        {"grid", s.grid},
                        {"scale_grid", s.scale_grid},
                        {"density", s.reference_density},
                        {"runs", row.runs}}},
          {"time_ms", times_json(row.statistics)},
          {"psnr_db", finite ? Json(*row.psnr_db) : Json()},
          {"paper_ms", paper_times(row)},
          {"paper_psnr_db", paper_of(row).tiled_psnr_db},
          {"paper_primitives", paper_counts(paper_of(row))},
          {"rays", row.statistics.rays},
          {"surface_hits", row.statistics.surface_hits},
          {"primitives", row.statistics.primitives},
          {"ghosts_rendered", row.statistics.ghosts_rendered},
          {"peak_memory_bytes", row.statistics.peak_memory_bytes}};
}

std::string phases_text(const RenderStatistics& statistics) {
  std::string text;
  for (const auto& [phase, ms] : statistics.time_ms) {
    if (phase != "total") text += fmt::format("{}{} {:.0f}", text.empty() ? "" : ", ", phase, ms);
  }
  return text;
}

std::string millions(double count) { return fmt::format("{:.2f}", count * 1e-6); }

std::string psnr_text(const std::optional<double>& psnr_db) {
  if (!psnr_db) return "-";
  return std::isfinite(*psnr_db) ? fmt::format("{:.2f}", *psnr_db) : "equal";
}

}  // namespace

Json bench_json(const std::vector<BenchRow>& rows) {
  const Machine machine = this_machine();
  Json list = Json::array();
  for (const BenchRow& row : rows) list.push_back(row_json(row));
  return {{"machine", {{"processor", machine.processor},
                       {"cores", machine.cores},
                       {"system", machine.system},
                       {"compiler", machine.compiler}}},
          {"rows", list}};
}

std::string bench_text(const std::vector<BenchRow>& rows) {
  const Machine machine = this_machine();
  TextTable table({"<system", "f/", "lights", "<method", "total ms", "paper ms", "PSNR dB", "paper dB", "M rays", "M hits",
                   "M primitives", "paper M", "<by phase, ms"});
  for (const BenchRow& row : rows) {
    const PaperFigures& paper = paper_of(row);
    const RenderStatistics& s = row.statistics;
    table.add({std::string(row.system->name), fmt::format("{:g}", row.system->f_number), fmt::format("{}", row.lights),
               s.method, fmt::format("{:.1f}", total_ms(s)), fmt::format("{:.2f}", paper_total_ms(row)),
               psnr_text(row.psnr_db), fmt::format("{:.2f}", paper.tiled_psnr_db),
               millions(static_cast<double>(s.rays)), millions(static_cast<double>(s.surface_hits)),
               millions(static_cast<double>(s.primitives)), millions(paper.primitives), phases_text(s)});
  }
  return fmt::format("{}, {} cores, {}, {}\n{}"
                     "paper: bodonyi2023, GeForce RTX 3060; ms: its \"previous method\" for bundle, its tiled one else;\n"
                     "dB: its tiled method against the previous one; primitives before merging\n",
                     machine.processor, machine.cores, machine.system, machine.compiler, table.text());
}

}  // namespace contrejour::cli
