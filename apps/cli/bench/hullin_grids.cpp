// SPDX-License-Identifier: Apache-2.0
// hullin2011 7.1: the number of ghosts for which a coarse grid of a given number of rays a side is enough. Each ghost
// is rendered alone and compared with its picture from the finest grid.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "cli/bench/hullin_scene.h"
#include "contrejour/expert/ghost.h"

namespace contrejour::cli {
namespace {

constexpr double kGood_db = 35.0;
constexpr int kFinestGrid = 256;
constexpr int kCoarseGrids[] = {4, 8, 16, 32};

struct GhostImage {
  Ghost ghost;
  Image image;
};

Result<HullinRender> render_alone(const HullinScene& scene, const Ghost& ghost, int grid, int threads) {
  HullinQuality quality = with_grid(scene, grid);
  quality.settings.selection = SelectList{{ghost}};
  return render_runs(scene, quality, {1, threads, {}});
}

// The pictures of the ghosts that are visible in the frame, from the finest grid.
Result<std::vector<GhostImage>> finest_images(const HullinScene& scene, int threads) {
  std::vector<GhostImage> visible;
  for (const Ghost& ghost : enumerate_ghosts(scene.lens, scene.settings.scope)) {
    auto rendered = render_alone(scene, ghost, kFinestGrid, threads);
    if (!rendered) return tl::unexpected(rendered.error());
    const bool is_visible = std::ranges::any_of(rendered->image.pixels, [](float v) { return v > 0; });
    if (is_visible) visible.push_back({ghost, std::move(rendered->image)});
  }
  return visible;
}

Result<int> count_good(const HullinScene& scene, const std::vector<GhostImage>& finest, int grid, int threads) {
  int good = 0;
  for (const GhostImage& one : finest) {
    const auto rendered = render_alone(scene, one.ghost, grid, threads);
    if (!rendered) return tl::unexpected(rendered.error());
    if (hullin_psnr_db(one.image, rendered->image).value_or(kGood_db) >= kGood_db) ++good;
  }
  return good;
}

}  // namespace

Result<std::vector<HullinRow>> measure_grids(const HullinSystem& system, const params::Values& values,
                                             const HullinRunning& running) {
  const auto scene = hullin_scene(system, kFourStops, values);
  if (!scene) return tl::unexpected(scene.error());
  const auto finest = finest_images(*scene, running.threads);
  if (!finest) return tl::unexpected(finest.error());
  const auto best = render_runs(*scene, with_grid(*scene, kFinestGrid), running);
  if (!best) return tl::unexpected(best.error());
  std::vector<HullinRow> rows;
  for (const int grid : kCoarseGrids) {
    const auto good = count_good(*scene, *finest, grid, running.threads);
    if (!good) return tl::unexpected(good.error());
    const auto rendered = render_runs(*scene, with_grid(*scene, grid), running);
    if (!rendered) return tl::unexpected(rendered.error());
    rows.push_back(row_of("grids", system, *scene, fmt::format("{0} x {0} rays", grid), *rendered));
    rows.back().psnr_db = hullin_psnr_db(best->image, rendered->image);
    rows.back().note = fmt::format("against {0} x {0}; {1} of {2} ghosts by themselves at {3:g} dB or better",
                                   kFinestGrid, *good, finest->size(), kGood_db);
    if (auto ok = show_picture(running, rows.back(), rendered->image); !ok) return tl::unexpected(ok.error());
  }
  return rows;
}

}  // namespace contrejour::cli
