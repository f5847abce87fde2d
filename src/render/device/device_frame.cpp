// SPDX-License-Identifier: Apache-2.0
#include "render/device/device_frame.h"

#include <iterator>
#include <utility>

#include "base/tasks.h"
#include "render/planning/layer_images.h"

namespace contrejour::inline internal {

DeviceFrame::DeviceFrame(const FramePlan& plan, const Frame& frame)
    : plan_(plan), frame_(frame), by_layer_(plan.layers ? plan.layers->count() : 1) {}

void DeviceFrame::add(std::size_t layer, std::vector<DeviceGrid> grids) {
  auto& all = by_layer_[layer];
  all.insert(all.end(), std::make_move_iterator(grids.begin()), std::make_move_iterator(grids.end()));
}

Context DeviceFrame::part(const Context& whole, Part of) {
  Context part = whole;
  if (whole.progress) part.progress = [&whole, of](double done) { whole.progress(of.from + (of.to - of.from) * done); };
  return part;
}

Result<DrawnFlare> DeviceFrame::draw(FrameDevice& device, const IrisShape& iris, const GridStyle& style,
                                     RenderStatistics statistics, const Context& context) {
  const double search_ms = ms_since(start_);
  LayerImages images(plan_, frame_);
  DeviceWork work;
  const auto count = static_cast<double>(by_layer_.size());
  for (std::size_t layer = 0; layer < by_layer_.size(); ++layer) {
    if (by_layer_[layer].empty() && plan_.layers) continue;
    const auto at = [&](double done) { return kSearch.to + (1.0 - kSearch.to) * done / count; };
    const Context drawing = part(context, {at(static_cast<double>(layer)), at(static_cast<double>(layer) + 1.0)});
    auto one = device.draw({frame_, iris, by_layer_[layer], style}, images.at(layer), drawing);
    if (!one) return tl::unexpected(one.error());
    work.add(*one);
  }
  if (context.progress) context.progress(1.0);
  DrawnFlare flare;
  images.move_to(flare);
  flare.statistics = std::move(statistics);
  flare.statistics.device = device.info().name;
  flare.statistics.primitives = work.primitives;
  flare.statistics.ghosts_rendered = static_cast<int>(plan_.ghosts.size());
  flare.statistics.ghosts_skipped_flux = plan_.skipped_flux;
  flare.statistics.time_ms = {{"search", search_ms}, {"device", work.ms}, {"total", search_ms + work.ms}};
  return flare;
}

std::string stop_lacks(const StopTransmittances& stops, const FramePlan& plan, const LensState& lens) {
  if (lens.iris.field) return "a picture as the iris is";
  if (stops.on()) return "ringing is";
  if (plan.dirt) return "dirt is";
  return {};
}

}  // namespace contrejour::inline internal
