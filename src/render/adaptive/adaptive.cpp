// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/adaptive.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <memory>
#include <numeric>
#include <optional>
#include <span>

#include "base/clock.h"
#include "base/tasks.h"
#include "render/adaptive/budget/item_budget.h"
#include "render/adaptive/device_items.h"
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
  [[nodiscard]] std::size_t memory_bytes() const {
    return cells.bytes([](const BoxCells& one) { return one.bytes(); }) + rasteriser.bytes();
  }
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

// Items that are drawn into one image, in their order, with their estimates.
struct PaintedItems {
  std::span<const Item> items;
  std::span<const ItemEstimate> estimates;

  [[nodiscard]] PaintedItems part(std::size_t first, std::size_t count) const {
    return {items.subspan(first, count), estimates.subspan(first, count)};
  }
};

// Paints items batch by batch and draws each batch: in the order of the items, whatever the number of threads.
class FramePainter {
 public:
  // budget: of each item.
  FramePainter(const Scene& scene, const Frame& frame, const PatternAtlas* atlas, const ErrorBudget& budget,
               Scratch& scratch, RenderCache& cache, const Context& context, std::size_t item_count)
      : scene_(scene), atlas_(atlas), budget_(budget), scratch_(scratch), cache_(cache), frame_(frame),
        context_(context), quiet_(context), item_count_(item_count), crop_margin_px_(scene.plan.dark_margin_px) {
    quiet_.progress = {};
    if (scene.plan.layers && !crop_margin_px_) crop_margin_px_ = 0;
  }

  void paint(const PaintedItems& all, DrawnImage& to) {
    const bool patterned = std::ranges::any_of(
        all.items, [](const Item& item) { return item.patterns != nullptr || !item.shadows.empty(); });
    const std::size_t item_count = all.items.size();
    mode_ = RasterMode::Write;
    if (item_count == 0) draw(*new_batch(), true, to);
    for (std::size_t done = 0; done < item_count;) {
      const std::unique_ptr<PolygonBatch> batch = new_batch();
      for (std::size_t lists = 0; done < item_count && batch->bytes() < kBatchBytes;) {
        const std::size_t count = std::min(patterned ? kPatternedItemsAtOnce : kItemsAtOnce, item_count - done);
        batch->extend(count);
        paint_some(all.part(done, count), *batch, lists);
        lists += count;
        if (context_.cancelled()) return;  // some items may not be painted
        done += count;
        painted_ += count;
      }
      paint_ms_ += watch_.lap_ms();
      draw(*batch, done == item_count, to);
      tiles_ms_ += watch_.lap_ms();
      if (context_.progress) context_.progress(static_cast<double>(painted_) / static_cast<double>(item_count_));
    }
  }

  [[nodiscard]] const Work& work() const { return work_; }
  [[nodiscard]] std::uint64_t primitives() const { return primitives_; }
  [[nodiscard]] double paint_ms() const { return paint_ms_; }
  [[nodiscard]] double tiles_ms() const { return tiles_ms_; }

 private:
  [[nodiscard]] std::unique_ptr<PolygonBatch> new_batch() {
    return scratch_.rasteriser.new_batch(frame_.width, frame_.height, atlas_);
  }

  // first: the list of the first item in the batch.
  void paint_some(const PaintedItems& some, PolygonBatch& batch, std::size_t first) {
    const std::size_t count = some.items.size();
    std::vector<Work> work(count);
    std::vector<std::size_t> primitives(count);
    const std::vector<std::size_t> order = longest_first(some.estimates, budget_.peak);
    std::atomic<std::size_t> next = 0;
    parallel_for(count, quiet_, [&](std::size_t) {
      const std::size_t k = order[next.fetch_add(1)];
      TessellatedItem tessellated =
          tessellate_item(scene_, some.items[k], some.estimates[k], frame_, budget_, scratch_.cells);
      work[k] = tessellated.work;
      primitives[k] = tessellated.polygons.polygons.size();
      batch.set(first + k, std::move(tessellated.polygons));
    });
    for (const Work& one : work) work_.add(one);
    for (const std::size_t polygons : primitives) primitives_ += polygons;
  }

  void draw(PolygonBatch& batch, bool is_last, DrawnImage& to) {
    const bool is_first = mode_ == RasterMode::Write;
    if (is_first && is_last && crop_margin_px_) return draw_illuminated_region(batch, *crop_margin_px_, to);
    if (is_first) to.image = unwritten_image(cache_, frame_.width, frame_.height);
    batch.draw(mode_, context_, {to.image});
    mode_ = RasterMode::Add;
  }

  void draw_illuminated_region(PolygonBatch& all, int margin_px, DrawnImage& to) {
    const PixelArea lit = all.touched();
    if (lit.x1 <= lit.x0) return;
    to.left = std::max(lit.x0 - margin_px, 0);
    to.top = std::max(lit.y0 - margin_px, 0);
    const int right = std::min(lit.x1 + margin_px, frame_.width);
    const int bottom = std::min(lit.y1 + margin_px, frame_.height);
    to.image = unwritten_image(cache_, right - to.left, bottom - to.top);
    all.draw(mode_, context_, {to.image, to.left, to.top});
  }

  const Scene& scene_;
  const PatternAtlas* atlas_;
  const ErrorBudget budget_;
  Scratch& scratch_;
  RenderCache& cache_;
  const Frame& frame_;
  const Context& context_;
  Context quiet_;
  std::size_t item_count_, painted_ = 0;
  std::optional<int> crop_margin_px_;
  RasterMode mode_ = RasterMode::Write;
  Work work_;
  std::uint64_t primitives_ = 0;
  Stopwatch watch_;
  double paint_ms_ = 0.0, tiles_ms_ = 0.0;
};

// Puts the items in the order of their layers, which share the estimates and the budget of the whole frame.
void sort_by_layer(std::vector<Item>& items, std::vector<ItemEstimate>& estimates) {
  std::vector<std::size_t> order(items.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return items[k].layer; });
  std::vector<Item> sorted_items;
  std::vector<ItemEstimate> sorted_estimates;
  for (const std::size_t k : order) {
    sorted_items.push_back(std::move(items[k]));
    sorted_estimates.push_back(estimates[k]);
  }
  items = std::move(sorted_items);
  estimates = std::move(sorted_estimates);
}

// The fraction of the light of the preview frame whose items are traced.
double traced_fraction(std::span<const Item> items, std::span<const ItemEstimate> estimates) {
  double traced = 0.0, sum = 0.0;
  for (std::size_t k = 0; k < items.size(); ++k) {
    const double light = estimates[k].level * estimates[k].area_px;
    sum += light;
    if (!items[k].is_fitted) traced += light;
  }
  return sum > 0.0 ? traced / sum : 0.0;
}

void paint_layers(FramePainter& painter, std::size_t layer_count, std::vector<Item>& items,
                  std::vector<ItemEstimate>& estimates, DrawnFlare& flare) {
  sort_by_layer(items, estimates);
  const PaintedItems all{items, estimates};
  flare.layers.resize(layer_count);
  for (std::size_t first = 0, end = 0; first < items.size(); first = end) {
    while (end < items.size() && items[end].layer == items[first].layer) ++end;
    painter.paint(all.part(first, end - first), flare.layers[items[first].layer]);
  }
}

}  // namespace

Result<DrawnFlare> render_adaptive(const PlannedFrame& planned, const AdaptiveOptions& options,
                                   const Context& context) {
  if (const auto good = check_error_bound(options.error); !good) return tl::unexpected(good.error());
  KeptDevice& kept = *planned.cache.section<KeptDevice>({});
  if (kept.may_draw(device_lacks(planned))) {
    auto drawn = draw_on_device(kept, planned, options, context);
    if (!kept.falls_back(drawn)) return drawn;
  }
  return draw_adaptive(planned, options.error, nullptr, context);
}

Result<DrawnFlare> draw_adaptive(const PlannedFrame& planned, double error, const pupils::FittedGhosts* fitted,
                                 const Context& context) {
  if (const auto good = check_error_bound(error); !good) return tl::unexpected(good.error());
  const auto& [lens, plan, settings, cache] = planned;
  const Frame& frame = settings.frame;
  Stopwatch whole;
  Stopwatch watch;

  DrawnFlare flare;
  const Scene scene{lens, plan, StepsByWavelength(lens, plan.tables), IrisShape(lens.iris), fitted, &context};
  Context quiet = context;
  quiet.progress = {};
  Work work;
  std::vector<Item> items = find_items(scene, quiet, work);
  if (context.cancelled()) return interrupted();
  if (scene.plan.dirt) dim_items(scene, items);
  const double bound_ms = watch.lap_ms();
  StopTransmittances stops(lens, settings, plan.dirt, cache);
  const std::shared_ptr<Scratch> scratch = cache.section<Scratch>({});
  PreviewFrame preview = draw_preview(scene, items, frame, scratch->cells, scratch->rasteriser, quiet, work);
  if (context.cancelled()) return interrupted();
  const bool dark = !(preview.peak > 0.0);
  const double traced_flux = traced_fraction(items, preview.estimates);
  const FrameError allowed{error * std::sqrt(plan.error_fraction),
                           std::max(dark ? faintest_peak(plan, frame) : preview.peak, plan.min_peak),
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
  FramePainter painter(scene, frame, atlas, budget_per_item(allowed, preview.estimates), *scratch, cache, context,
                       items.size());
  if (plan.layers)
    paint_layers(painter, plan.layers->count(), items, preview.estimates, flare);
  else
    painter.paint({items, preview.estimates}, flare.picture);
  if (context.cancelled()) return interrupted();

  work.add(painter.work());
  RenderStatistics& stats = flare.statistics;
  stats.method = "adaptive";
  if (fitted != nullptr) stats.traced_flux = traced_flux;
  stats.rays = work.rays;
  stats.surface_hits = work.surface_hits;
  stats.primitives = painter.primitives();
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
