// SPDX-License-Identifier: Apache-2.0
#include "render/device/device_frame.h"

#include <utility>

#include "base/tasks.h"
#include "render/device/kept_device.h"
#include "render/device/kept_device_dirt.h"
#include "render/device/kept_patterns.h"
#include "render/planning/frame_memory.h"
#include "render/planning/layer_images.h"

namespace contrejour::inline internal {

std::size_t layer_count(const FramePlan& plan) { return plan.layers ? plan.layers->count() : 1; }

Context part_of(const Context& whole, ProgressPart part) {
  Context out = whole;
  if (whole.progress)
    out.progress = [&whole, part](double done) { whole.progress(part.from + (part.to - part.from) * done); };
  return out;
}

Result<DrawnFlare> draw_layers(FrameDevice& device, DeviceTarget target, const std::vector<bool>& has_light,
                               const DrawLayer& draw_layer, const Context& context) {
  const FramePlan& plan = target.plan;
  LayerImages images(plan, target.frame);
  if (!plan.layers) images.set(0, unwritten_image(target.cache, target.frame.width, target.frame.height));
  DeviceWork work;
  const auto count = static_cast<double>(has_light.size());
  for (std::size_t layer = 0; layer < has_light.size(); ++layer) {
    if (!has_light[layer] && plan.layers) continue;
    const auto at = [&](double done) { return kDeviceSearch.to + (1.0 - kDeviceSearch.to) * done / count; };
    const Context drawing = part_of(context, {at(static_cast<double>(layer)), at(static_cast<double>(layer) + 1.0)});
    const auto one = draw_layer(layer, images.at(layer), drawing);
    if (!one) return tl::unexpected(one.error());
    work.add(*one);
  }
  if (context.progress) context.progress(1.0);
  KeptDevice& kept = *target.cache.section<KeptDevice>({});
  kept.has_added_starbursts = work.starbursts > 0;
  kept.has_kept_picture = work.is_kept;
  DrawnFlare flare;
  images.move_to(flare);
  flare.statistics = std::move(target.statistics);
  RenderStatistics& stats = flare.statistics;
  stats.device = device.info().name;
  stats.primitives = work.primitives;
  if (stats.rays == 0) stats.rays = work.rays;
  stats.device_invocations = work.invocations;
  stats.device_bytes = work.bytes;
  stats.ghosts_rendered = static_cast<int>(plan.ghosts.size());
  stats.ghosts_skipped_flux = plan.skipped_flux;
  stats.time_ms = {{"search", target.search_ms}, {"device", work.ms}};
  for (const auto& [stage, ms] : work.stages_ms) stats.time_ms.emplace_back("device: " + stage, ms);
  stats.time_ms.emplace_back("total", target.search_ms + work.ms);
  return flare;
}

DeviceFrame::DeviceFrame(const FramePlan& plan, const Frame& frame, RenderCache& cache)
    : plan_(plan), frame_(frame), cache_(cache), by_layer_(layer_count(plan)) {}

// Ghosts may share a pattern.
std::uint32_t DeviceFrame::number_of(const std::shared_ptr<const StopPattern>& pattern) {
  if (!pattern) return DevicePatterns::kNone;
  const auto [at, is_new] = number_of_.try_emplace(pattern.get(), static_cast<std::uint32_t>(patterns_.size()));
  if (is_new) patterns_.push_back(pattern);
  return at->second;
}

void DeviceFrame::add(std::size_t layer, std::vector<PatternedGrid> grids) {
  for (PatternedGrid& one : grids) {
    one.grid.pattern = number_of(one.pattern);
    by_layer_[layer].push_back(std::move(one.grid));
  }
}

Result<DrawnFlare> DeviceFrame::draw(FrameDevice& device, const Iris& iris, const GridStyle& style,
                                     RenderStatistics statistics, const Context& context) {
  std::vector<bool> has_light;
  for (const auto& grids : by_layer_) has_light.push_back(!grids.empty());
  const IrisShape shape(iris);
  const auto patterns = cache_.section<KeptPatterns>({})->get(patterns_, iris);
  const auto dirt = cache_.section<KeptDeviceDirt>({})->get(plan_.dirt);
  return draw_layers(
      device, {plan_, frame_, cache_, std::move(statistics), ms_since(start_)}, has_light,
      [&](std::size_t layer, Image& image, const Context& drawing) {
        const KeptDevice& kept = *cache_.section<KeptDevice>({});
        return device.draw(GridJob{frame_, shape, by_layer_[layer], style, kept.starbursts, kept.use, patterns, dirt},
                           image, drawing);
      },
      context);
}

std::string stop_lacks(const StopTransmittances& stops, const FramePlan& plan) {
  return plan.dirt && stops.has_fringed_dirt() ? "dirt with ringing is" : "";
}

}  // namespace contrejour::inline internal
