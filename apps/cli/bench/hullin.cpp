// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/hullin.h"

#include <utility>

#include <fmt/format.h>

#include "cli/bench/hullin_scene.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

// The layouts of figure 15 show primes and zooms of the same types; the text names only the zooms.
constexpr HullinSystem kHullinSystems[] = {{"tessar"},
                                           {"heliar"},
                                           {"angenieux-double-gauss"},
                                           {"itoh-zoom", 123.0},
                                           {"nikon-80-200", 140.0},
                                           {"canon-70-200", 135.0}};
constexpr HullinSystem kNikon[] = {{"nikon-80-200", 140.0}};
constexpr HullinSystem kCanon{"canon-70-200", 135.0};  // that of figure 19
constexpr HullinSystem kZoomAndPrime[] = {kCanon, {"heliar"}};
constexpr HullinSystem kWellBehaved[] = {{"tessar"}, {"heliar"}, {"itoh-zoom", 123.0}, {"nikon-80-200", 140.0}};

// Renders wide open and stopped down by four stops, at both qualities.
Result<std::vector<HullinRow>> figure_15(const HullinSystem& system, const params::Values& values,
                                         const HullinRunning& running) {
  std::vector<HullinRow> rows;
  for (const double f_number_factor : {1.0, kFourStops}) {
    const auto scene = hullin_scene(system, f_number_factor, values);
    if (!scene) return tl::unexpected(scene.error());
    const auto high = render_runs(*scene, high_quality(*scene), running);
    if (!high) return tl::unexpected(high.error());
    const auto normal = render_runs(*scene, normal_quality(*scene, weakest_first(*scene)), running);
    if (!normal) return tl::unexpected(normal.error());
    rows.push_back(row_of("15", system, *scene, "high quality", *high));
    if (auto ok = show_picture(running, rows.back(), high->image); !ok) return tl::unexpected(ok.error());
    rows.push_back(row_of("15", system, *scene, "normal quality", *normal));
    rows.back().psnr_db = hullin_psnr_db(high->image, normal->image);
    rows.back().note = "against high quality";
    if (auto ok = show_picture(running, rows.back(), normal->image); !ok) return tl::unexpected(ok.error());
  }
  return rows;
}

// Compares both qualities, and measures the gain of omitting the weakest ghosts alone. According to section 6, omitting
// 20 per cent of them gains 20 per cent, and omitting 40 per cent about 50.
Result<std::vector<HullinRow>> figure_17(const HullinSystem& system, const params::Values& values,
                                         const HullinRunning& running) {
  constexpr double kHigh_ms = 1e3 / 6.1, kNormal_ms = 1e3 / 20.6;
  const auto scene = hullin_scene(system, kFourStops, values);
  if (!scene) return tl::unexpected(scene.error());
  const std::vector<Ghost> ghosts = weakest_first(*scene);
  std::vector<HullinRow> rows;
  Image best;
  double all_ms = 0.0;
  const auto add = [&](std::string what, const HullinQuality& quality, double paper_ms) -> Result<void> {
    auto rendered = render_runs(*scene, quality, running);
    if (!rendered) return tl::unexpected(rendered.error());
    HullinRow row = row_of("17", system, *scene, std::move(what), *rendered);
    row.paper_ms = paper_ms;
    if (!best.pixels.empty()) {
      row.psnr_db = hullin_psnr_db(best, rendered->image);
      row.note = "against high quality";
    }
    if (all_ms > 0.0)
      row.note += fmt::format(", {:.0f} per cent faster than all ghosts", 100.0 * (all_ms / row.ms - 1.0));
    if (row.what == "all ghosts") all_ms = row.ms;
    if (auto ok = show_picture(running, row, rendered->image); !ok) return ok;
    if (best.pixels.empty()) best = std::move(rendered->image);
    rows.push_back(std::move(row));
    return {};
  };
  if (auto ok = add("high quality", high_quality(*scene), kHigh_ms); !ok) return tl::unexpected(ok.error());
  HullinQuality quality{scene->bundle, scene->settings};
  if (auto ok = add("all ghosts", quality, 0.0); !ok) return tl::unexpected(ok.error());
  quality.settings.selection = without_weakest(ghosts, 0.2);
  if (auto ok = add("without the weakest 20 per cent", quality, 0.0); !ok) return tl::unexpected(ok.error());
  if (auto ok = add("normal quality", normal_quality(*scene, ghosts), kNormal_ms); !ok)
    return tl::unexpected(ok.error());
  return rows;
}

// Compares dense rays with sparse bundles, for the figure's zoom and for a prime with few ghosts beside it.
Result<std::vector<HullinRow>> figure_19(const HullinSystem& system, const params::Values& values,
                                         const HullinRunning& running) {
  const bool in_paper = system.lens == kCanon.lens;
  const double dense_ms = in_paper ? 159e3 : 0.0, sparse_ms = in_paper ? 29.8 : 0.0;
  const auto scene = hullin_scene(system, kFourStops, values);
  if (!scene) return tl::unexpected(scene.error());
  const auto dense = render_runs(*scene, {params::reference_options(values), scene->settings}, running);
  if (!dense) return tl::unexpected(dense.error());
  std::vector<HullinRow> rows{row_of("19", system, *scene, "dense rays", *dense)};
  rows.back().paper_ms = dense_ms;
  if (auto ok = show_picture(running, rows.back(), dense->image); !ok) return tl::unexpected(ok.error());
  const std::pair<const char*, MethodOptions> sparse_methods[] = {{"ray bundles", scene->bundle},
                                                                  {"adaptive", params::adaptive_options(values)}};
  for (const auto& [what, method] : sparse_methods) {
    const auto sparse = render_runs(*scene, {method, scene->settings}, running);
    if (!sparse) return tl::unexpected(sparse.error());
    rows.push_back(row_of("19", system, *scene, what, *sparse));
    rows.back().psnr_db = hullin_psnr_db(dense->image, sparse->image);
    rows.back().note = "against dense rays";
    if (rows.back().what == "ray bundles") rows.back().paper_ms = sparse_ms;
    if (auto ok = show_picture(running, rows.back(), sparse->image); !ok) return tl::unexpected(ok.error());
  }
  return rows;
}

constexpr HullinFigure kHullinFigures[] = {
    {"15", "Figure 15: lenses wide open and closed by four stops", kHullinSystems, figure_15},
    {"17",
     "Figure 17: high quality (7 bands, filtered) and normal (RGB, without the weakest 40 per cent of the ghosts)",
     kNikon, figure_17},
    {"19", "Figure 19: dense rays and sparse bundles", kZoomAndPrime, figure_19},
    {"grids", "Section 7.1: what coarse grids do to ghosts", kWellBehaved, measure_grids}};

}  // namespace

std::span<const HullinFigure> hullin_figures() { return kHullinFigures; }

}  // namespace contrejour::cli
