// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/hullin.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "cli/bench/repeats.h"
#include "cli/bench/report.h"
#include "cli/flare_report.h"
#include "cli/long_task.h"
#include "cli/text_table.h"
#include "contrejour/expert/ghost.h"
#include "contrejour/expert/metrics.h"
#include "contrejour/expert/settings.h"
#include "contrejour/expert/trace.h"
#include "contrejour/render.h"

namespace contrejour::cli {
namespace {

constexpr Vec2 kLight_uv{0.70, 0.33};
constexpr double kFourStops = 4.0;  // as a factor of f-numbers
constexpr double kRankedAt_nm = 550.0;

// Figure 15's lens layouts show primes and zooms of the same kinds; the text names only the zooms.
constexpr HullinSystem kHullinSystems[] = {{"tessar"},
                                           {"heliar"},
                                           {"angenieux-double-gauss"},
                                           {"itoh-zoom", 123.0},
                                           {"nikon-80-200", 140.0},
                                           {"canon-70-200", 135.0}};
constexpr HullinSystem kNikon[] = {{"nikon-80-200", 140.0}};
constexpr HullinSystem kCanon[] = {{"canon-70-200", 135.0}};
constexpr HullinSystem kWellBehaved[] = {{"tessar"}, {"heliar"}, {"itoh-zoom", 123.0}, {"nikon-80-200", 140.0}};

// A lens with the light of all figures, stopped down by some stops.
struct HullinScene {
  LensState lens;
  Light light;
  BundleOptions bundle;
  FrameSettings settings;
};

Result<HullinScene> scene_of(const HullinSystem& system, double times_f_number, const params::Values& values) {
  const auto prescription = find_lens(std::string(system.lens));
  if (!prescription) return tl::unexpected(prescription.error());
  LensSettings wanted;
  if (system.focal_length_mm > 0.0) wanted.focal_length_mm = system.focal_length_mm;
  auto open = configure_lens(*prescription, wanted);
  if (!open) return tl::unexpected(open.error());
  wanted.f_number = open->f_number * times_f_number;
  auto lens = configure_lens(*prescription, wanted);
  if (!lens) return tl::unexpected(lens.error());
  HullinScene scene{std::move(*lens), {}, params::bundle_options(values), {}};
  const Frame frame = params::whole_frame(values, scene.lens, *params::parse_size(*values.text("size")));
  scene.light.direction =
      direction_for_image_point(scene.lens, frame.sensor_from_uv(kLight_uv), scene.lens.design_wavelength_nm);
  scene.settings = params::frame_settings(values, frame, ColourSpace::Rec709);
  scene.settings.scope = GhostScope::OneSideOfStop;  // as in the paper
  return scene;
}

// The ghosts, the weakest first, by the flux of their light at one wavelength.
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

// All ghosts but the weakest, in the order in which they are rendered.
SelectList without_weakest(const std::vector<Ghost>& weakest_first, double share) {
  const auto dropped = static_cast<std::ptrdiff_t>(share * static_cast<double>(weakest_first.size()));
  return {{weakest_first.begin() + dropped, weakest_first.end()}};
}

// A method's options, and the settings of its frame.
struct Quality {
  MethodOptions method;
  FrameSettings settings;
};

// 7 bands and filtering across them; the paper's supersampling is not needed where pixels are covered exactly.
Quality high_quality(const HullinScene& scene) {
  BundleOptions bundle = scene.bundle;
  bundle.spectral_filter = true;
  Quality quality{bundle, scene.settings};
  quality.settings.wavelengths = 7;
  return quality;
}

// RGB, no filtering, without the weakest 40 per cent of the ghosts.
Quality normal_quality(const HullinScene& scene, const std::vector<Ghost>& ghosts) {
  Quality quality{scene.bundle, scene.settings};
  quality.settings.wavelengths = 3;
  quality.settings.selection = without_weakest(ghosts, 0.4);
  return quality;
}

// All ghosts with this number of rays a side.
Quality with_grid(const HullinScene& scene, int rays) {
  BundleOptions bundle = scene.bundle;
  bundle.grid.rays = rays;
  return {bundle, scene.settings};
}

struct Drawn {
  Image image;
  double ms = 0;
  int ghosts = 0;
};

// Renders several times and keeps the fastest time.
Result<Drawn> draw(const HullinScene& scene, const Quality& quality, const HullinRunning& running) {
  const std::string_view method = quality.method.name();
  Drawn drawn{{}, std::numeric_limits<double>::infinity(), 0};
  double all_ms = 0.0;
  for (int run = 0; another_run(run, method_traits(method)->is_slow ? 1 : running.runs, all_ms); ++run) {
    const LongTask task(fmt::format("{}, {}", scene.lens.name, method), running.threads);
    auto flare = render(quality.method, scene.lens, {&scene.light, 1}, quality.settings, task.context());
    if (!flare) return tl::unexpected(flare.error());
    const double ms = total_ms(flare->statistics);
    all_ms += ms;
    drawn.ms = std::min(drawn.ms, ms);
    drawn.ghosts = flare->statistics.ghosts_rendered;
    drawn.image = std::move(flare->image);
  }
  return drawn;
}

std::optional<double> psnr_db(const Image& truth, const Image& image) {
  const auto comparison = compare(truth, image);
  return comparison ? comparison->psnr_db : std::nullopt;
}

HullinRow row_of(const char* figure, const HullinSystem& system, const HullinScene& scene, std::string what,
                 const Drawn& drawn) {
  return {.figure = figure,
          .lens = std::string(system.lens),
          .f_number = scene.lens.f_number,
          .what = std::move(what),
          .ghosts = drawn.ghosts,
          .ms = drawn.ms};
}

std::string picture_name(const HullinRow& row) {
  std::string name =
      fmt::format("{}-{}-f{:g}-{}", row.figure, row.lens, std::round(row.f_number * 10.0) / 10.0, row.what);
  std::ranges::replace(name, ' ', '-');
  return name;
}

Result<void> show(const HullinRunning& running, const HullinRow& row, const Image& image) {
  return running.show ? running.show(picture_name(row), image) : Result<void>{};
}

// Wide open and stopped down by four stops, at both qualities.
Result<std::vector<HullinRow>> figure_15(const HullinSystem& system, const params::Values& values,
                                         const HullinRunning& running) {
  std::vector<HullinRow> rows;
  for (const double closed : {1.0, kFourStops}) {
    const auto scene = scene_of(system, closed, values);
    if (!scene) return tl::unexpected(scene.error());
    const auto high = draw(*scene, high_quality(*scene), running);
    if (!high) return tl::unexpected(high.error());
    const auto normal = draw(*scene, normal_quality(*scene, weakest_first(*scene)), running);
    if (!normal) return tl::unexpected(normal.error());
    rows.push_back(row_of("15", system, *scene, "high quality", *high));
    if (auto ok = show(running, rows.back(), high->image); !ok) return tl::unexpected(ok.error());
    rows.push_back(row_of("15", system, *scene, "normal quality", *normal));
    rows.back().psnr_db = psnr_db(high->image, normal->image);
    rows.back().note = "against high quality";
    if (auto ok = show(running, rows.back(), normal->image); !ok) return tl::unexpected(ok.error());
  }
  return rows;
}

// Both qualities compared, and the gain of leaving out the weakest ghosts alone (section 6: leaving out 20 per cent of
// them gains 20 per cent, 40 about 50).
Result<std::vector<HullinRow>> figure_17(const HullinSystem& system, const params::Values& values,
                                         const HullinRunning& running) {
  constexpr double kHigh_ms = 1e3 / 6.1, kNormal_ms = 1e3 / 20.6;
  const auto scene = scene_of(system, kFourStops, values);
  if (!scene) return tl::unexpected(scene.error());
  const std::vector<Ghost> ghosts = weakest_first(*scene);
  std::vector<HullinRow> rows;
  Image best;
  double all_ms = 0.0;
  const auto add = [&](std::string what, const Quality& quality, double paper_ms) -> Result<void> {
    auto drawn = draw(*scene, quality, running);
    if (!drawn) return tl::unexpected(drawn.error());
    HullinRow row = row_of("17", system, *scene, std::move(what), *drawn);
    row.paper_ms = paper_ms;
    if (!best.pixels.empty()) {
      row.psnr_db = psnr_db(best, drawn->image);
      row.note = "against high quality";
    }
    if (all_ms > 0.0)
      row.note += fmt::format(", {:.0f} per cent faster than all ghosts", 100.0 * (all_ms / row.ms - 1.0));
    if (row.what == "all ghosts") all_ms = row.ms;
    if (auto ok = show(running, row, drawn->image); !ok) return ok;
    if (best.pixels.empty()) best = std::move(drawn->image);
    rows.push_back(std::move(row));
    return {};
  };
  if (auto ok = add("high quality", high_quality(*scene), kHigh_ms); !ok) return tl::unexpected(ok.error());
  Quality quality{scene->bundle, scene->settings};
  if (auto ok = add("all ghosts", quality, 0.0); !ok) return tl::unexpected(ok.error());
  quality.settings.selection = without_weakest(ghosts, 0.2);
  if (auto ok = add("without the weakest 20 per cent", quality, 0.0); !ok) return tl::unexpected(ok.error());
  if (auto ok = add("normal quality", normal_quality(*scene, ghosts), kNormal_ms); !ok)
    return tl::unexpected(ok.error());
  return rows;
}

// Dense rays compared with sparse bundles.
Result<std::vector<HullinRow>> figure_19(const HullinSystem& system, const params::Values& values,
                                         const HullinRunning& running) {
  constexpr double kDense_ms = 159e3, kSparse_ms = 29.8;
  const auto scene = scene_of(system, kFourStops, values);
  if (!scene) return tl::unexpected(scene.error());
  const auto dense = draw(*scene, {params::reference_options(values), scene->settings}, running);
  if (!dense) return tl::unexpected(dense.error());
  std::vector<HullinRow> rows{row_of("19", system, *scene, "dense rays", *dense)};
  rows.back().paper_ms = kDense_ms;
  if (auto ok = show(running, rows.back(), dense->image); !ok) return tl::unexpected(ok.error());
  const std::pair<const char*, MethodOptions> sparse_methods[] = {{"ray bundles", scene->bundle},
                                                                  {"adaptive", params::adaptive_options(values)}};
  for (const auto& [what, method] : sparse_methods) {
    const auto sparse = draw(*scene, {method, scene->settings}, running);
    if (!sparse) return tl::unexpected(sparse.error());
    rows.push_back(row_of("19", system, *scene, what, *sparse));
    rows.back().psnr_db = psnr_db(dense->image, sparse->image);
    rows.back().note = "against dense rays";
    if (rows.back().what == "ray bundles") rows.back().paper_ms = kSparse_ms;
    if (auto ok = show(running, rows.back(), sparse->image); !ok) return tl::unexpected(ok.error());
  }
  return rows;
}

// The number of ghosts for which a coarse grid of a given number of rays a side is enough (7.1): each ghost alone is
// compared with its picture from the finest grid.
Result<std::vector<HullinRow>> grids(const HullinSystem& system, const params::Values& values,
                                     const HullinRunning& running) {
  constexpr double kGood_db = 35.0;
  constexpr int kFinest = 256;
  const auto scene = scene_of(system, kFourStops, values);
  if (!scene) return tl::unexpected(scene.error());
  const std::vector<Ghost> ghosts = enumerate_ghosts(scene->lens, scene->settings.scope);
  const auto alone = [&](Ghost ghost, int grid) {
    Quality quality = with_grid(*scene, grid);
    quality.settings.selection = SelectList{{ghost}};
    return draw(*scene, quality, {1, running.threads, {}});
  };
  const auto is_lit = [](const Image& image) {
    return std::ranges::any_of(image.pixels, [](float v) { return v > 0; });
  };
  std::vector<Image> finest;
  std::vector<Ghost> seen;
  for (const Ghost& ghost : ghosts) {
    auto drawn = alone(ghost, kFinest);
    if (!drawn) return tl::unexpected(drawn.error());
    if (!is_lit(drawn->image)) continue;
    finest.push_back(std::move(drawn->image));
    seen.push_back(ghost);
  }
  const auto best = draw(*scene, with_grid(*scene, kFinest), running);
  if (!best) return tl::unexpected(best.error());
  std::vector<HullinRow> rows;
  for (const int grid : {4, 8, 16, 32}) {
    int good = 0;
    for (std::size_t k = 0; k < seen.size(); ++k) {
      const auto drawn = alone(seen[k], grid);
      if (!drawn) return tl::unexpected(drawn.error());
      good += psnr_db(finest[k], drawn->image).value_or(kGood_db) >= kGood_db ? 1 : 0;
    }
    const auto drawn = draw(*scene, with_grid(*scene, grid), running);
    if (!drawn) return tl::unexpected(drawn.error());
    rows.push_back(row_of("grids", system, *scene, fmt::format("{0} x {0} rays", grid), *drawn));
    rows.back().psnr_db = psnr_db(best->image, drawn->image);
    rows.back().note = fmt::format("against {0} x {0}; {1} of {2} ghosts by themselves at {3:g} dB or better", kFinest,
                                   good, seen.size(), kGood_db);
    if (auto ok = show(running, rows.back(), drawn->image); !ok) return tl::unexpected(ok.error());
  }
  return rows;
}

constexpr HullinFigure kFigures[] = {
    {"15", "Figure 15: lenses wide open and closed by four stops", kHullinSystems, figure_15},
    {"17",
     "Figure 17: high quality (7 bands, filtered) and normal (RGB, without the weakest 40 per cent of the ghosts)",
     kNikon, figure_17},
    {"19", "Figure 19: dense rays and sparse bundles", kCanon, figure_19},
    {"grids", "Section 7.1: what coarse grids do to ghosts", kWellBehaved, grids}};

}  // namespace

std::span<const HullinFigure> hullin_figures() { return kFigures; }

std::string hullin_text(const HullinFigure& figure, const std::vector<HullinRow>& rows) {
  TextTable table({"<lens", "f/", "<rendered", "ghosts", "ms", "frames/s", "paper ms", "PSNR dB", "<"});
  for (const HullinRow& row : rows) {
    table.add({row.lens, fmt::format("{:.1f}", row.f_number), row.what, fmt::format("{}", row.ghosts),
               fmt::format("{:.1f}", row.ms), fmt::format("{:.1f}", 1e3 / row.ms),
               row.paper_ms > 0.0 ? fmt::format("{:.4g}", row.paper_ms) : "",
               row.psnr_db ? fmt::format("{:.1f}", *row.psnr_db) : "", row.note});
  }
  return fmt::format("{}\n{}", figure.title, table.text());
}

Json hullin_json(const std::vector<HullinRow>& rows) {
  Json list = Json::array();
  for (const HullinRow& row : rows) {
    list.push_back({{"figure", row.figure},
                    {"lens", row.lens},
                    {"f_number", row.f_number},
                    {"rendered", row.what},
                    {"ghosts_rendered", row.ghosts},
                    {"time_ms", row.ms},
                    {"paper_ms", row.paper_ms > 0.0 ? Json(row.paper_ms) : Json()},
                    {"psnr_db", row.psnr_db ? Json(*row.psnr_db) : Json()},
                    {"note", row.note}});
  }
  return {{"machine", machine_text()}, {"rows", std::move(list)}};
}

}  // namespace contrejour::cli
