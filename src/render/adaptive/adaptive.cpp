// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/adaptive.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>

#include "base/clock.h"
#include "base/tasks.h"
#include "render/adaptive/budget/item_budget.h"
#include "render/adaptive/item.h"
#include "render/adaptive/patterned_items.h"
#include "render/adaptive/shadowed_items.h"
#include "render/adaptive/tiles/tiles.h"
#include "render/planning/error_bound.h"
#include "render/planning/frame_memory.h"

namespace contrejour::inline internal {
namespace {

using namespace adaptive;

// A batch of polygons is drawn as soon as it takes this many bytes, or slightly more.
constexpr std::size_t kBatchBytes = std::size_t{32} << 20U;
constexpr std::size_t kItemsAtOnce = 256;
// The same where items may have a transmittance for each pixel, which takes much memory.
constexpr std::size_t kPatternedItemsAtOnce = 16;

// Scratch memory that later frames use again: a section of RenderCache. Its contents change no picture.
struct Scratch {
  struct Key {
    friend bool operator==(const Key&, const Key&) = default;
  };
  explicit Scratch(const Key& /*key*/) {}
  Pool<BoxCells> cells;
  TileRasteriser rasteriser;
};

// Measures the milliseconds between laps.
class Stopwatch {
 public:
  [[nodiscard]] double lap_ms() {
    const double ms = ms_since(last_);
    last_ = Clock::now();
    return ms;
  }

 private:
  Clock::time_point last_ = Clock::now();
};

// Orders the items by falling cost, so that no thread is left with a long one at the end. Items of about equal cost
// keep their order, since neighbours pass the same surfaces.
std::vector<std::size_t> longest_first(std::span<const ItemEstimate> estimates, double peak) {
  std::vector<int> doublings;
  for (const ItemEstimate& estimate : estimates) {
    // The cost in rays of the preview frame. Measurements show that an item's visible light costs about as much as this
    // many rays.
    const double visible =
        estimate.level * peak_limited_weight(estimate.level, peak) / peak * std::sqrt(std::max(estimate.area_px, 0.0));
    doublings.push_back(std::ilogb(std::max(estimate.rays + visible, 1.0)));
  }
  std::vector<std::size_t> order(estimates.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t k) { return doublings[k]; });
  return order;
}

// Paints the items batch by batch and draws each batch: in the order of the items, whatever the number of threads.
class FramePainter {
 public:
  FramePainter(const Scene& scene, const Frame& frame, const PatternAtlas* atlas, Scratch& scratch, RenderCache& cache,
               const Context& context, DrawnFlare& flare)
      : scene_(scene), atlas_(atlas), scratch_(scratch), cache_(cache), frame_(frame), context_(context),
        quiet_(context), flare_(flare) {
    quiet_.progress = {};
  }

  void paint(const std::vector<Item>& items, const std::vector<ItemEstimate>& estimates, const ErrorBudget& budget) {
    const bool patterned =
        std::ranges::any_of(items, [](const Item& item) { return item.patterns != nullptr || !item.shadows.empty(); });
    mode_ = RasterMode::Write;
    if (items.empty()) draw(*new_batch(), true);
    for (std::size_t done = 0; done < items.size();) {
      const std::unique_ptr<PolygonBatch> batch = new_batch();
      for (std::size_t lists = 0; done < items.size() && batch->bytes() < kBatchBytes;) {
        const std::size_t count = std::min(patterned ? kPatternedItemsAtOnce : kItemsAtOnce, items.size() - done);
        batch->extend(count);
        paint_some({items.data() + done, count}, {estimates.data() + done, count}, budget, *batch, lists);
        lists += count;
        if (context_.cancelled()) return;  // some items may not be painted
        done += count;
      }
      paint_ms_ += watch_.lap_ms();
      draw(*batch, done == items.size());
      tiles_ms_ += watch_.lap_ms();
      if (context_.progress) context_.progress(static_cast<double>(done) / static_cast<double>(items.size()));
    }
  }

  [[nodiscard]] const Work& work() const { return work_; }
  [[nodiscard]] double paint_ms() const { return paint_ms_; }
  [[nodiscard]] double tiles_ms() const { return tiles_ms_; }

 private:
  [[nodiscard]] std::unique_ptr<PolygonBatch> new_batch() {
    return scratch_.rasteriser.new_batch(frame_.width, frame_.height, atlas_);
  }

  // first: the list of the first item in the batch.
  void paint_some(std::span<const Item> items, std::span<const ItemEstimate> estimates, const ErrorBudget& budget,
                  PolygonBatch& batch, std::size_t first) {
    std::vector<Work> work(items.size());
    std::vector<std::size_t> primitives(items.size());
    const std::vector<std::size_t> order = longest_first(estimates, budget.peak);
    std::atomic<std::size_t> next = 0;
    parallel_for(items.size(), quiet_, [&](std::size_t) {
      const std::size_t k = order[next.fetch_add(1)];
      TessellatedItem tessellated = tessellate_item(scene_, items[k], estimates[k], frame_, budget, scratch_.cells);
      work[k] = tessellated.work;
      primitives[k] = tessellated.polygons.polygons.size();
      batch.set(first + k, std::move(tessellated.polygons));
    });
    for (const Work& one : work) work_.add(one);
    for (const std::size_t count : primitives) flare_.statistics.primitives += count;
  }

  void draw(PolygonBatch& batch, bool is_last) {
    const bool is_first = mode_ == RasterMode::Write;
    if (is_first && is_last && scene_.plan.dark_margin_px)
      return draw_illuminated_region(batch, *scene_.plan.dark_margin_px);
    if (is_first) flare_.image = unwritten_image(cache_, frame_.width, frame_.height);
    batch.draw(mode_, context_, {flare_.image});
    mode_ = RasterMode::Add;
  }

  void draw_illuminated_region(PolygonBatch& all, int margin_px) {
    const PixelArea lit = all.touched();
    if (lit.x1 <= lit.x0) return;
    flare_.left = std::max(lit.x0 - margin_px, 0);
    flare_.top = std::max(lit.y0 - margin_px, 0);
    const int right = std::min(lit.x1 + margin_px, frame_.width);
    const int bottom = std::min(lit.y1 + margin_px, frame_.height);
    flare_.image = Image::unwritten(right - flare_.left, bottom - flare_.top);
    all.draw(mode_, context_, {flare_.image, flare_.left, flare_.top});
  }

  const Scene& scene_;
  const PatternAtlas* atlas_;
  Scratch& scratch_;
  RenderCache& cache_;
  const Frame& frame_;
  const Context& context_;
  Context quiet_;
  DrawnFlare& flare_;
  RasterMode mode_ = RasterMode::Write;
  Work work_;
  Stopwatch watch_;
  double paint_ms_ = 0.0, tiles_ms_ = 0.0;
};

}  // namespace

Result<DrawnFlare> render_adaptive(const PlannedFrame& planned, const AdaptiveOptions& options,
                                   const Context& context) {
  if (const auto good = check_error_bound(options.error); !good) return tl::unexpected(good.error());
  const auto& [lens, plan, settings, cache] = planned;
  const Frame& frame = settings.frame;
  Stopwatch whole;
  Stopwatch watch;

  DrawnFlare flare;
  const Scene scene{lens, plan, StepsByWavelength(lens, plan.tables), IrisShape(lens.iris)};
  Context quiet = context;
  quiet.progress = {};
  Work work;
  std::vector<Item> items = find_items(scene, quiet, work);
  if (context.cancelled()) return interrupted();
  if (scene.plan.dirt) dim_items(scene, items);
  const double bound_ms = watch.lap_ms();
  StopTransmittances stops(lens, settings, plan.dirt, cache);
  const std::shared_ptr<Scratch> scratch = cache.section<Scratch>({});
  const PreviewFrame preview = draw_preview(scene, items, frame, scratch->cells, scratch->rasteriser, quiet, work);
  if (context.cancelled()) return interrupted();
  const bool dark = !(preview.peak > 0.0);
  const FrameError allowed{options.error, std::max(dark ? faintest_peak(plan, frame) : preview.peak, plan.min_peak),
                           static_cast<double>(frame.width) * frame.height};
  if (stops.on() && !dark) work.add(set_stop_patterns(scene, stops, items, preview.estimates, allowed, quiet));
  if (context.cancelled()) return interrupted();
  if (!dark) {
    const std::vector<bool> negligible = negligible_items(preview.estimates, allowed);
    for (std::size_t k = 0; k < items.size(); ++k) items[k].is_negligible = negligible[k];
  }
  if (scene.plan.dirt && !dark) shadow_items(scene, stops, items, preview.estimates, allowed, quiet);
  if (context.cancelled()) return interrupted();
  const double peak_ms = watch.lap_ms();
  const PatternAtlas* const atlas = stops.patterns() ? &stops.patterns()->atlas() : nullptr;
  FramePainter painter(scene, frame, atlas, *scratch, cache, context, flare);
  painter.paint(items, preview.estimates, budget_per_item(allowed, preview.estimates));
  if (context.cancelled()) return interrupted();

  work.add(painter.work());
  RenderStatistics& stats = flare.statistics;
  stats.method = "adaptive";
  stats.rays = work.rays;
  stats.surface_hits = work.surface_hits;
  stats.ghosts_rendered = static_cast<int>(plan.ghosts.size());
  stats.ghosts_skipped_flux = plan.skipped_flux;
  stats.time_ms = {{"bound", bound_ms},
                   {"peak", peak_ms},
                   {"paint", painter.paint_ms()},
                   {"tiles", painter.tiles_ms()},
                   {"total", whole.lap_ms()}};
  return flare;
}

}  // namespace contrejour::inline internal
