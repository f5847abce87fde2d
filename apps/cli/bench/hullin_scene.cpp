// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/hullin_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "cli/bench/repeats.h"
#include "cli/flare_report.h"
#include "cli/long_task.h"
#include "contrejour/expert/ghost.h"
#include "contrejour/expert/metrics.h"
#include "contrejour/expert/settings.h"
#include "contrejour/expert/trace.h"

namespace contrejour::cli {
namespace {

constexpr Vec2 kHullinLight_uv{0.70, 0.33};
constexpr double kRankedAt_nm = 550.0;

std::string picture_name(const HullinRow& row) {
  std::string name =
      fmt::format("{}-{}-f{:g}-{}", row.figure, row.lens, std::round(row.f_number * 10.0) / 10.0, row.what);
  std::ranges::replace(name, ' ', '-');
  return name;
}

}  // namespace

Result<HullinScene> hullin_scene(const HullinSystem& system, double f_number_factor, const params::Values& values) {
  const auto prescription = find_lens(std::string(system.lens));
  if (!prescription) return tl::unexpected(prescription.error());
  LensSettings lens_settings;
  if (system.focal_length_mm > 0.0) lens_settings.focal_length_mm = system.focal_length_mm;
  auto open = configure_lens(*prescription, lens_settings);
  if (!open) return tl::unexpected(open.error());
  lens_settings.f_number = open->f_number * f_number_factor;
  auto lens = configure_lens(*prescription, lens_settings);
  if (!lens) return tl::unexpected(lens.error());
  HullinScene scene{std::move(*lens), {}, params::bundle_options(values), {}};
  const Frame frame = params::whole_frame(values, scene.lens, *params::parse_size(*values.text("size")));
  scene.light.direction =
      direction_for_image_point(scene.lens, frame.sensor_from_uv(kHullinLight_uv), scene.lens.design_wavelength_nm);
  scene.settings = params::frame_settings(values, frame, ColourSpace::Rec709);
  scene.settings.scope = GhostScope::OneSideOfStop;  // as in the paper
  return scene;
}

std::vector<Ghost> weakest_first(const HullinScene& scene) {
  std::vector<Ghost> ghosts = enumerate_ghosts(scene.lens, scene.settings.scope);
  const GhostMeter meter(scene.lens, kRankedAt_nm);
  const LightSource source = scene.light.source();
  std::vector<double> flux;
  for (const Ghost& ghost : ghosts) flux.push_back(meter.measure(ghost, source).flux_mm2);
  std::vector<std::size_t> order(ghosts.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return flux[k]; });
  std::vector<Ghost> sorted;
  for (const std::size_t k : order) sorted.push_back(ghosts[k]);
  return sorted;
}

SelectList without_weakest(const std::vector<Ghost>& weakest_first, double fraction) {
  const auto dropped = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(weakest_first.size()));
  return {{weakest_first.begin() + dropped, weakest_first.end()}};
}

HullinQuality high_quality(const HullinScene& scene) {
  BundleOptions bundle = scene.bundle;
  bundle.spectral_filter = true;
  HullinQuality quality{bundle, scene.settings};
  quality.settings.wavelengths = 7;
  return quality;
}

HullinQuality normal_quality(const HullinScene& scene, const std::vector<Ghost>& ghosts) {
  HullinQuality quality{scene.bundle, scene.settings};
  quality.settings.wavelengths = 3;
  quality.settings.selection = without_weakest(ghosts, 0.4);
  return quality;
}

HullinQuality with_grid(const HullinScene& scene, int rays) {
  BundleOptions bundle = scene.bundle;
  bundle.grid.rays = rays;
  return {bundle, scene.settings};
}

Result<HullinRender> render_runs(const HullinScene& scene, const HullinQuality& quality, const HullinRunning& running) {
  const std::string_view method = quality.method.name();
  HullinRender rendered{{}, std::numeric_limits<double>::infinity(), 0};
  double all_ms = 0.0;
  for (int run = 0; another_run(run, method_traits(method)->is_slow ? 1 : running.runs, all_ms); ++run) {
    const LongTask task(fmt::format("{}, {}", scene.lens.name, method), running.threads);
    auto flare = render(quality.method, scene.lens, {&scene.light, 1}, quality.settings, task.context());
    if (!flare) return tl::unexpected(flare.error());
    const double ms = total_ms(flare->statistics);
    all_ms += ms;
    rendered.ms = std::min(rendered.ms, ms);
    rendered.ghosts = flare->statistics.ghosts_rendered;
    rendered.image = std::move(flare->image);
  }
  return rendered;
}

std::optional<double> hullin_psnr_db(const Image& truth, const Image& image) {
  const auto comparison = compare(truth, image);
  return comparison ? comparison->psnr_db : std::nullopt;
}

HullinRow row_of(const char* figure, const HullinSystem& system, const HullinScene& scene, std::string what,
                 const HullinRender& rendered) {
  return {.figure = figure,
          .lens = std::string(system.lens),
          .f_number = scene.lens.f_number,
          .what = std::move(what),
          .ghosts = rendered.ghosts,
          .ms = rendered.ms};
}

Result<void> show_picture(const HullinRunning& running, const HullinRow& row, const Image& image) {
  return running.show ? running.show(picture_name(row), image) : Result<void>{};
}

}  // namespace contrejour::cli
