#include "render/adaptive/adaptive.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "base/memory.h"
#include "base/tasks.h"
#include "contrejour/metrics.h"
#include "render/adaptive/ghost_painter.h"
#include "render/adaptive/pupil_boxes.h"
#include "render/adaptive/tiles.h"

namespace contrejour {
namespace {

using namespace adaptive;
using Clock = std::chrono::steady_clock;

constexpr double kPeakQuantile = 0.999;  // as metrics.h: what errors are relative to
constexpr double kMargin = 0.03;  // of a box's size, on every side, for the other wavelengths
constexpr int kDeepest = 4;  // quarterings of a box
constexpr int kPreviewScale = 8;
constexpr std::size_t kBatchBytes = 48U << 20U;
constexpr std::size_t kBatchItems = 64;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// A ghost of a light, with the part of the entrance plane whose rays get through.
struct Item {
  Ghost ghost;
  const PlannedLight* light = nullptr;
  std::vector<Rectangle> boxes;
  std::uint64_t rays = 0, hits = 0;
};

struct Scene {
  const LensState& lens;
  const RenderSettings& settings;
  const FramePlan& plan;
  const TablesByWavelength& tables;
  IrisShape iris;
};

std::vector<Item> items_of(const FramePlan& plan) {
  std::vector<Item> items;
  for (const Ghost& ghost : plan.ghosts) {
    for (const PlannedLight& light : plan.lights) items.push_back({ghost, &light, {}, 0, 0});
  }
  return items;
}

const PlannedPass& middle_pass(const PlannedLight& light) { return light.passes[light.passes.size() / 2]; }

// Where rays get through, at the middle wavelength, with a margin for the others.
void find_box(const Scene& scene, Item& item) {
  const Meridian meridian(item.light->direction);
  const double lambda_nm = middle_pass(*item.light).lambda_nm;
  const OpticalPath path = ghost_path(scene.lens, item.ghost, lambda_nm);
  const auto window = entrance_window(scene.lens, meridian.direction);
  PupilBoxes found = find_pupil_boxes(path, *scene.tables.at(lambda_nm), meridian, window);
  item.rays = found.rays;
  item.hits = found.rays * path.steps.size();
  for (Rectangle& box : found.boxes) {
    const Vec2 margin = (box.high - box.low) * kMargin;
    box = {box.low - margin, box.high + margin};
  }
  item.boxes = std::move(found.boxes);
}

// Polygons of an item at every wavelength of its light.
PolygonList paint_item(const Scene& scene, const Item& item, const Frame& frame, ErrorBudget budget, int deepest,
                       std::uint64_t& rays, std::uint64_t& hits) {
  PolygonList out;
  const Meridian meridian(item.light->direction);
  const double z = entrance_window(scene.lens, meridian.direction).z_mm;
  GhostPainter painter(scene.lens, scene.iris, frame, meridian, z, scene.tables, deepest);
  const std::span<const PlannedPass> passes(item.light->passes);
  for (std::size_t k = 0; k < passes.size(); ++k) {
    for (const Rectangle& box : item.boxes) painter.paint({item.ghost, box, {passes[k].lambda_nm, passes.subspan(k, 1)}},
                  {budget.squared_error / static_cast<double>(passes.size()), budget.peak}, out);
  }
  rays += painter.rays();
  hits += painter.surface_hits();
  return out;
}

// The frame at an eighth of its size, with cells as large as can be: good enough to tell how bright its peaks are.
double find_peak(const Scene& scene, const std::vector<Item>& items, const Context& context, std::uint64_t& rays,
                 std::uint64_t& hits) {
  Frame frame = scene.settings.frame;
  frame.width = std::max(1, frame.width / kPreviewScale);
  frame.height = std::max(1, frame.height / kPreviewScale);
  frame.origin_x /= kPreviewScale;
  frame.origin_y /= kPreviewScale;
  frame.full_width = std::max(1, frame.full_width / kPreviewScale);
  frame.full_height = std::max(1, frame.full_height / kPreviewScale);
  frame.pixel_pitch_mm *= kPreviewScale;
  const TileGrid grid(frame.width, frame.height);
  std::vector<TiledPolygons> painted(items.size());
  std::vector<std::array<std::uint64_t, 2>> counts(items.size());
  Context quiet = context;
  quiet.progress = {};
  parallel_for(items.size(), quiet, [&](std::size_t k) {
    const Item& item = items[k];
    if (!item.boxes.empty()) {
      PlannedPass all{middle_pass(*item.light).lambda_nm, {}};
      for (const PlannedPass& pass : item.light->passes) {
        for (std::size_t c = 0; c < 3; ++c) all.gain[c] += pass.gain[c];
      }
      const PlannedLight light{item.light->direction, {all}};
      Item one = item;
      one.light = &light;
      painted[k].list = paint_item(scene, one, frame, {std::numeric_limits<double>::infinity(), 1.0}, 1, counts[k][0], counts[k][1]);
    }
    painted[k].tiles = tile_lists(painted[k].list, grid);
  });
  for (const auto& c : counts) {
    rays += c[0];
    hits += c[1];
  }
  Image image(frame.width, frame.height, 3);
  for (int row = 0; row < grid.rows; ++row) add_tile_row(painted, grid, row, image);
  const double peak = quantile_of_samples(image, kPeakQuantile) / (kPreviewScale * kPreviewScale);
  if (peak > 0.0) return peak;
  const auto largest = std::max_element(image.pixels.begin(), image.pixels.end());
  return largest == image.pixels.end() ? 0.0 : *largest / (kPreviewScale * kPreviewScale);
}

}  // namespace

Result<Flare> render_adaptive(const LensState& lens, std::span<const Light> lights, const RenderSettings& settings,
                              const Context& context) {
  const auto start = Clock::now();
  const auto plan = plan_frame(lens, lights, settings, context);
  if (!plan) return tl::unexpected<Error>(plan.error());
  const double plan_ms = ms_since(start);
  const TablesByWavelength tables = tables_for(*plan, lens, context);
  if (context.cancelled()) return failure(ErrorCode::Cancelled, "interrupted");
  const double tables_ms = ms_since(start);
  const Scene scene{lens, settings, *plan, tables, IrisShape(lens.iris)};

  Flare flare;
  flare.image = Image(settings.frame.width, settings.frame.height, 3);
  RenderStatistics& stats = flare.statistics;
  std::vector<Item> items = items_of(*plan);
  Context quiet = context;
  quiet.progress = {};
  parallel_for(items.size(), quiet, [&](std::size_t k) { find_box(scene, items[k]); });
  for (const Item& item : items) {
    stats.rays += item.rays;
    stats.surface_hits += item.hits;
  }
  const double bound_ms = ms_since(start);
  const double peak = find_peak(scene, items, context, stats.rays, stats.surface_hits);
  const double peak_ms = ms_since(start);

  const double pixels = static_cast<double>(settings.frame.width) * settings.frame.height;
  const double allowed = (getenv("ERR") ? atof(getenv("ERR")) : settings.error) * peak;
  const double squared_error = allowed * allowed * pixels / static_cast<double>(std::max<std::size_t>(items.size(), 1));
  const TileGrid grid(settings.frame.width, settings.frame.height);
  double paint_ms = 0.0;
  double tiles_ms = 0.0;
  for (std::size_t first = 0; first < items.size();) {
    auto begin = Clock::now();
    std::vector<TiledPolygons> painted;
    std::size_t bytes = 0;
    while (first < items.size() && bytes < kBatchBytes) {
      const std::size_t count = std::min(kBatchItems, items.size() - first);
      std::vector<TiledPolygons> some(count);
      std::vector<std::array<std::uint64_t, 2>> counts(count);
      parallel_for(count, quiet, [&](std::size_t k) {
        const Item& item = items[first + k];
        if (!item.boxes.empty()) some[k].list = paint_item(scene, item, settings.frame, {squared_error, peak}, kDeepest, counts[k][0], counts[k][1]);
        some[k].tiles = tile_lists(some[k].list, grid);
      });
      if (context.cancelled()) return failure(ErrorCode::Cancelled, "interrupted");
      for (std::size_t k = 0; k < count; ++k) {
        stats.rays += counts[k][0];
        stats.surface_hits += counts[k][1];
        stats.primitives += some[k].list.polygons.size();
        bytes += some[k].list.bytes() + some[k].tiles.bytes();
        painted.push_back(std::move(some[k]));
      }
      first += count;
      if (context.progress) context.progress(static_cast<double>(first) / static_cast<double>(items.size()));
    }
    paint_ms += ms_since(begin);
    begin = Clock::now();
    parallel_for(static_cast<std::size_t>(grid.rows), quiet,
                 [&](std::size_t row) { add_tile_row(painted, grid, static_cast<int>(row), flare.image); });
    if (context.cancelled()) return failure(ErrorCode::Cancelled, "interrupted");
    tiles_ms += ms_since(begin);
  }

  stats.method = "adaptive";
  stats.ghosts_rendered = static_cast<int>(plan->ghosts.size());
  stats.ghosts_skipped_flux = plan->skipped_flux;
  stats.peak_memory_bytes = peak_memory_bytes();
  stats.time_ms = {{"plan", plan_ms},
                   {"tables", tables_ms - plan_ms},
                   {"bound", bound_ms - tables_ms},
                   {"peak", peak_ms - bound_ms},
                   {"paint", paint_ms},
                   {"tiles", tiles_ms},
                   {"total", ms_since(start)}};
  return flare;
}

}  // namespace contrejour
