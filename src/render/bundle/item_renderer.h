// SPDX-License-Identifier: Apache-2.0
// One ghost of one light at a few wavelengths, drawn into a box of its own: the unit of work of the threads.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "render/bundle/band_blur.h"
#include "render/bundle/flux_box.h"
#include "render/bundle/ghost_grid.h"
#include "render/planning/frame_plan.h"
#include "render/stop_patterns/dirt_shadows.h"

namespace contrejour::inline internal::bundle {

struct Item {
  Ghost ghost;
  const AppliedAdjustment* adjustment = nullptr;
  const PlannedLight* light = nullptr;
  std::span<const PlannedPass> passes;
  bool are_blurred = false;  // into each other
  std::size_t layer = 0;     // of the plan's
};

// RGB values of the pixels that the item touches.
struct RenderedItem {
  PixelBox box;
  std::vector<float> rgb;
  Counts counts;
};

// Every ghost and light of a plan, a few passes in an item; all passes in one where bands are blurred into each other.
[[nodiscard]] std::vector<Item> items_of(const FramePlan& plan, const BundleOptions& options);

class ItemRenderer {
 public:
  // item, the source's options and context must outlive the renderer.
  ItemRenderer(const Item& item, const Frame& frame, const GridSource& source, const Context& context);

  // Incomplete when the context is cancelled.
  [[nodiscard]] RenderedItem render();

 private:
  using Layer = std::optional<FluxBox>;

  [[nodiscard]] std::vector<Layer> draw_all();
  [[nodiscard]] std::vector<Layer> draw_and_blur();
  [[nodiscard]] Layer draw_blurred(const GhostPupil& pupil, const std::optional<BandMotion>& motion);
  [[nodiscard]] FluxBox draw(const GhostPupil& pupil, const Frame& frame);
  [[nodiscard]] RenderedItem merge(const std::vector<Layer>& layers);

  const Item& item_;
  const BundleOptions& options_;
  Frame frame_;  // moved by the ghost's offset
  const Context& context_;
  GhostGrid grid_;
};

}  // namespace contrejour::inline internal::bundle
