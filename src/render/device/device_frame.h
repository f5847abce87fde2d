// SPDX-License-Identifier: Apache-2.0
// A frame that a device draws from grids, layer by layer: what the methods that draw grids have in common.
// Thread-safety: one thread at a time.
#pragma once

#include <string>
#include <vector>

#include "base/clock.h"
#include "render/device/frame_device.h"
#include "render/planning/frame_plan.h"
#include "render/stop_patterns/stop_transmittances.h"

namespace contrejour::inline internal {

class DeviceFrame {
 public:
  DeviceFrame(const FramePlan& plan, const Frame& frame);

  void add(std::size_t layer, std::vector<DeviceGrid> grids);

  // Draws all layers. statistics: those of the search. Errors: those of the device; Cancelled.
  [[nodiscard]] Result<DrawnFlare> draw(FrameDevice& device, const IrisShape& iris, const GridStyle& style,
                                        RenderStatistics statistics, const Context& context);

  // Parts of the progress.
  struct Part {
    double from, to;
  };
  static constexpr Part kSearch{0.0, 0.3};
  [[nodiscard]] static Context part(const Context& whole, Part of);

 private:
  const FramePlan& plan_;
  const Frame& frame_;
  Clock::time_point start_ = Clock::now();
  std::vector<std::vector<DeviceGrid>> by_layer_;
};

// Names what devices cannot do at the stop yet, in words for a report: "ringing is"; empty: nothing.
[[nodiscard]] std::string stop_lacks(const StopTransmittances& stops, const FramePlan& plan, const LensState& lens);

}  // namespace contrejour::inline internal
