#include "render/bundle/bundle.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "base/memory.h"
#include "base/tasks.h"
#include "render/bundle/cell_raster.h"
#include "ghosts/pupil_search.h"
#include "render/interface/frame_plan.h"
#include "render/interface/grid_side.h"
#include "render/interface/wavelength_tables.h"

namespace contrejour {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kLowestGrid = 16;
constexpr int kHighestGrid = 512;
// Wavelengths that one item draws before they are added up: fewer, larger additions.
constexpr std::size_t kPassesPerItem = 4;
// Below 32 rays a side a caustic in a small ghost shows the grid as a four-pointed star.
constexpr int kFewestScaled = 32;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// One ghost of one light at a few wavelengths.
struct Item {
  Ghost ghost;
  const PlannedLight* light = nullptr;
  std::span<const PlannedPass> passes;
};

struct Counts {
  std::uint64_t rays = 0, surface_hits = 0, primitives = 0;
  double search_ms = 0, trace_ms = 0, raster_ms = 0;

  void add(const Counts& other) {
    rays += other.rays;
    surface_hits += other.surface_hits;
    primitives += other.primitives;
    search_ms += other.search_ms;
    trace_ms += other.trace_ms;
    raster_ms += other.raster_ms;
  }
};

// RGB over the pixels that the item touches.
struct RenderedItem {
  bundle::PixelBox box;
  std::vector<float> rgb;
  Counts counts;
};

std::vector<Item> items_of(const FramePlan& plan) {
  std::vector<Item> items;
  for (const Ghost& ghost : plan.ghosts) {
    for (const PlannedLight& light : plan.lights) {
      const std::span<const PlannedPass> all(light.passes);
      for (std::size_t first = 0; first < all.size(); first += kPassesPerItem) {
        items.push_back({ghost, &light, all.subspan(first, std::min(kPassesPerItem, all.size() - first))});
      }
    }
  }
  return items;
}

class ItemRenderer {
 public:
  ItemRenderer(const Item& item, const LensState& lens, const RenderSettings& settings,
               const TablesByWavelength& tables, const Context& context)
      : item_(item), lens_(lens), settings_(settings), tables_(tables), context_(context), iris_(lens.iris) {}

  [[nodiscard]] RenderedItem render() {
    std::vector<std::optional<bundle::FluxBox>> layers;
    for (const PlannedPass& pass : item_.passes) {
      if (context_.cancelled()) return {};
      layers.push_back(draw(pass));
    }
    return merge(layers);
  }

 private:
  std::optional<bundle::FluxBox> draw(const PlannedPass& pass) {
    const OpticalPath path = ghost_path(lens_, item_.ghost, pass.lambda_nm);
    const ReflectanceTables& tables = *tables_.at(pass.lambda_nm);
    const Vec3 direction = item_.light->direction;
    const EntranceWindow window = entrance_window(lens_, direction);

    auto start = Clock::now();
    const auto region = find_pupil_region(path, tables, iris_, direction, window, grid_);
    counts_.search_ms += ms_since(start);
    if (!region) return std::nullopt;
    count_rays(region->rays, path);

    start = Clock::now();
    const int side = grid_side(settings_, lens_, region->sensor_mm, kFewestScaled);
    const auto precision = precision_for(path, tables, direction, window.z_mm, region->pupil_mm, side,
                                                 settings_.frame.pixel_pitch_mm);
    grid_.trace(path, tables, iris_, direction, window.z_mm, region->pupil_mm, side, precision);
    count_rays(static_cast<std::uint64_t>(side) * static_cast<std::uint64_t>(side), path);
    counts_.trace_ms += ms_since(start);

    start = Clock::now();
    bundle::CellRaster raster(grid_, iris_, settings_.frame, direction.z);
    bundle::FluxBox flux = raster.draw([&] { return context_.cancelled(); });
    counts_.primitives += raster.primitives();
    counts_.raster_ms += ms_since(start);
    return flux;
  }

  void count_rays(std::uint64_t rays, const OpticalPath& path) {
    counts_.rays += rays;
    counts_.surface_hits += rays * path.steps.size();
  }

  [[nodiscard]] RenderedItem merge(const std::vector<std::optional<bundle::FluxBox>>& layers) {
    const auto start = Clock::now();
    RenderedItem out;
    for (const auto& layer : layers) {
      if (!layer || layer->box().empty()) continue;
      const bundle::PixelBox b = layer->box();
      out.box = out.box.empty() ? b
                                : bundle::PixelBox{std::min(out.box.x0, b.x0), std::min(out.box.y0, b.y0),
                                                   std::max(out.box.x1, b.x1), std::max(out.box.y1, b.y1)};
    }
    const auto width = static_cast<std::size_t>(out.box.width());
    out.rgb.resize(3 * width * static_cast<std::size_t>(out.box.height()));
    for (std::size_t k = 0; k < layers.size(); ++k) {
      if (!layers[k] || layers[k]->box().empty()) continue;
      const bundle::PixelBox b = layers[k]->box();
      const Rgb& gain = item_.passes[k].gain;
      const std::array<float, 3> g{static_cast<float>(gain[0]), static_cast<float>(gain[1]),
                                   static_cast<float>(gain[2])};
      for (int y = b.y0; y < b.y1; ++y) {
        float* to = out.rgb.data() + 3 * (static_cast<std::size_t>(y - out.box.y0) * width +
                                          static_cast<std::size_t>(b.x0 - out.box.x0));
        for (const float flux : layers[k]->row(y)) {
          for (std::size_t c = 0; c < 3; ++c) *to++ += g[c] * flux;
        }
      }
    }
    counts_.raster_ms += ms_since(start);
    out.counts = counts_;
    return out;
  }

  const Item& item_;
  const LensState& lens_;
  const RenderSettings& settings_;
  const TablesByWavelength& tables_;
  const Context& context_;
  IrisShape iris_;
  RayGrid grid_;
  Counts counts_;
};

void add_to(Image& image, const RenderedItem& item) {
  const auto row_length = 3 * static_cast<std::size_t>(item.box.width());
  for (int y = item.box.y0; y < item.box.y1; ++y) {
    float* to = image.pixels.data() + image.index(item.box.x0, y);
    const float* from = item.rgb.data() + row_length * static_cast<std::size_t>(y - item.box.y0);
    for (std::size_t k = 0; k < row_length; ++k) to[k] += from[k];
  }
}

// Search, trace and raster run side by side on all threads: each gets its share of the time that went by.
std::vector<std::pair<std::string, double>> phase_times(const Counts& counts, double plan_ms, double accumulate_ms,
                                                        double total_ms) {
  const double busy_ms = counts.search_ms + counts.trace_ms + counts.raster_ms;
  const double scale = busy_ms > 0.0 ? std::max(0.0, total_ms - plan_ms - accumulate_ms) / busy_ms : 0.0;
  return {{"plan", plan_ms},
          {"search", counts.search_ms * scale},
          {"trace", counts.trace_ms * scale},
          {"raster", counts.raster_ms * scale},
          {"accumulate", accumulate_ms},
          {"total", total_ms}};
}

}  // namespace

Result<Flare> render_bundle(const LensState& lens, std::span<const Light> lights, const RenderSettings& settings,
                            const Context& context) {
  const auto start = Clock::now();
  if (settings.grid < kLowestGrid || settings.grid > kHighestGrid) {
    return failure(ErrorCode::InvalidArgument,
                   "a grid of " + std::to_string(settings.grid) + " rays a side is out of range; choose 16 to 512");
  }
  const auto plan = plan_frame(lens, lights, settings, context);
  if (!plan) return tl::unexpected<Error>(plan.error());
  const TablesByWavelength tables = tables_for(*plan, lens, context);
  if (context.cancelled()) return failure(ErrorCode::Cancelled, "interrupted");
  const double plan_ms = ms_since(start);

  Flare flare;
  flare.image = Image(settings.frame.width, settings.frame.height, 3);
  Counts counts;
  double accumulate_ms = 0.0;
  const auto items = items_of(*plan);
  const bool done = ordered_pipeline(
      items.size(), context,
      [&](std::size_t k) { return ItemRenderer(items[k], lens, settings, tables, context).render(); },
      [&](std::size_t, const RenderedItem& item) {
        const auto added = Clock::now();
        add_to(flare.image, item);
        counts.add(item.counts);
        accumulate_ms += ms_since(added);
      });
  if (!done) return failure(ErrorCode::Cancelled, "interrupted");

  RenderStatistics& stats = flare.statistics;
  stats.method = "bundle";
  stats.rays = counts.rays;
  stats.surface_hits = counts.surface_hits;
  stats.primitives = counts.primitives;
  stats.ghosts_rendered = static_cast<int>(plan->ghosts.size());
  stats.ghosts_skipped_flux = plan->skipped_flux;
  stats.peak_memory_bytes = peak_memory_bytes();
  stats.time_ms = phase_times(counts, plan_ms, accumulate_ms, ms_since(start));
  return flare;
}

}  // namespace contrejour
