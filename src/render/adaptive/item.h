// SPDX-License-Identifier: Apache-2.0
// Items, the units of work: a ghost of a light, with the boxes of the pupil that it passes.
#pragma once

#include "base/pool.h"
#include "render/adaptive/budget/item_budget.h"
#include "render/adaptive/ghost_tessellator.h"
#include "render/planning/frame_plan.h"
#include "render/polygons/rasteriser.h"

namespace contrejour::inline internal::adaptive {

// The data that all items of a frame have in common.
struct Scene {
  const LensState& lens;
  const FramePlan& plan;
  StepsByWavelength steps;  // for the wavelengths of the plan
  IrisShape iris;
  const FittedGhosts* fitted = nullptr;  // null: all rays are traced
  const Context* context = nullptr;  // once it is cancelled, polygons may be missing; null: never
};

struct Work {
  std::uint64_t rays = 0, surface_hits = 0;  // traced
  void add(const Work& other) {
    rays += other.rays;
    surface_hits += other.surface_hits;
  }
};

struct Item {
  Ghost ghost;
  const AppliedAdjustment* adjustment = nullptr;
  const PlannedLight* light = nullptr;
  EntranceWindow window;  // of the light
  std::size_t layer = 0;  // of the plan's
  std::size_t pieces = 1;  // of the light, with an item for each
  std::vector<Rectangle> boxes;  // in the light's meridional frame; empty: no light gets through
  std::shared_ptr<const GhostPatterns> patterns = nullptr;  // null: the iris is sharp
  // Transmittance of dirt: one a pass, or one for all; empty: no shadows are drawn, and
  std::vector<std::shared_ptr<const DirtShadows>> shadows = {};
  double dirt_transmittance = 1.0;  // the item is dimmed by this transmittance
  bool is_negligible = false;     // drawn in preview quality, at all wavelengths
  bool is_fitted = false;  // its rays are evaluated
};

// One item for each ghost and light, in the order of the plan.
[[nodiscard]] std::vector<Item> find_items(const Scene& scene, const Context& context, Work& work);

struct TessellatedItem {
  PolygonList polygons;
  Work work;
  std::uint64_t rays = 0;  // traced or evaluated
};

// Widens the item's boxes to contain the light that its stop patterns transmit.
[[nodiscard]] Work widen_boxes(const Scene& scene, Item& item);

// Tessellates an item in all wavelengths of its light. estimate: the item's in the preview frame.
[[nodiscard]] TessellatedItem tessellate_item(const Scene& scene, const Item& item, const ItemEstimate& estimate,
                                              const Frame& frame, const ErrorBudget& budget,
                                              Pool<BoxCells>& scratch_pool);

struct PreviewFrame {
  double peak = 0;  // that errors are relative to: 99.9 per cent of samples are below it (metrics.h)
  std::vector<ItemEstimate> estimates;  // one an item; empty if cancelled
};
[[nodiscard]] PreviewFrame draw_preview(const Scene& scene, const std::vector<Item>& items, const Frame& frame,
                                        Pool<BoxCells>& scratch_pool, Rasteriser& rasteriser, const Context& context,
                                        Work& work);

}  // namespace contrejour::inline internal::adaptive
