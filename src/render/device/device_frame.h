// SPDX-License-Identifier: Apache-2.0
// A frame that a device draws, layer by layer: what all methods have in common.
// Thread-safety: one thread at a time.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/clock.h"
#include "render/device/frame_device.h"
#include "render/planning/frame_plan.h"
#include "render/stop_patterns/stop_transmittances.h"

namespace contrejour::inline internal {

// Draws the light of a layer into its image, which it replaces.
using DrawLayer = std::function<Result<DeviceWork>(std::size_t layer, Image& image, const Context& context)>;

// The frame that is drawn, and what is known of it before.
struct DeviceTarget {
  const FramePlan& plan;
  const Frame& frame;
  RenderCache& cache;  // whose memory the picture uses
  RenderStatistics statistics;  // of the search
  double search_ms = 0.0;
};

// Draws all layers that have light. has_light: by layer. Errors: those of the device; Cancelled.
[[nodiscard]] Result<DrawnFlare> draw_layers(FrameDevice& device, DeviceTarget target,
                                             const std::vector<bool>& has_light, const DrawLayer& draw_layer,
                                             const Context& context);

// The number of the plan's layers, 1 where there is one picture.
[[nodiscard]] std::size_t layer_count(const FramePlan& plan);

// Parts of the progress.
struct ProgressPart {
  double from, to;
};
inline constexpr ProgressPart kDeviceSearch{0.0, 0.3};
[[nodiscard]] Context part_of(const Context& whole, ProgressPart part);

// A grid, and the stop pattern of its ghost at its wavelength; null: the iris is sharp.
struct PatternedGrid {
  DeviceGrid grid;
  std::shared_ptr<const StopPattern> pattern;
};

// The grids of a frame, by layer, for the methods that draw grids.
class DeviceFrame {
 public:
  DeviceFrame(const FramePlan& plan, const Frame& frame, RenderCache& cache);

  void add(std::size_t layer, std::vector<PatternedGrid> grids);

  // Draws all layers. iris: the lens's. statistics: those of the search. Errors: those of the device; Cancelled.
  [[nodiscard]] Result<DrawnFlare> draw(FrameDevice& device, const Iris& iris, const GridStyle& style,
                                        RenderStatistics statistics, const Context& context);

 private:
  const FramePlan& plan_;
  const Frame& frame_;
  RenderCache& cache_;
  Clock::time_point start_ = Clock::now();
  [[nodiscard]] std::uint32_t number_of(const std::shared_ptr<const StopPattern>& pattern);

  std::vector<std::vector<DeviceGrid>> by_layer_;
  std::vector<std::shared_ptr<const StopPattern>> patterns_;  // of all layers
  std::map<const StopPattern*, std::uint32_t> number_of_;
};

// Names what devices cannot do at the stop yet, in words for a report: "dirt with ringing is"; empty: nothing.
[[nodiscard]] std::string stop_lacks(const StopTransmittances& stops, const FramePlan& plan);

}  // namespace contrejour::inline internal
