// The units of work: a ghost of a light, with the parts of the pupil it comes through.
#pragma once

#include "base/pool.h"
#include "render/adaptive/ghost_painter.h"
#include "render/adaptive/tiles/tiles.h"
#include "render/interface/frame_plan.h"

namespace contrejour::adaptive {

// What all items of a frame share.
struct Scene {
  const LensState& lens;
  const FramePlan& plan;
  StepsByWavelength steps;  // of the plan's wavelengths
  IrisShape iris;
};

struct Work {
  std::uint64_t rays = 0, surface_hits = 0;
  void add(const Work& other) {
    rays += other.rays;
    surface_hits += other.surface_hits;
  }
};

struct Item {
  Ghost ghost;
  const GhostLook* look = nullptr;
  const PlannedLight* light = nullptr;
  EntranceWindow window;  // of the light
  std::vector<Rectangle> boxes;  // in the light's meridional frame; none: nothing gets through
  std::shared_ptr<const GhostScreens> screens = nullptr;  // null: the iris is sharp
  // What dirt lets through: one a pass, or one for all; none: no shadows, and
  std::vector<std::shared_ptr<const DirtScreen>> shadows = {};
  double past_dirt = 1.0;  // all of it is dimmed to this share
  bool is_faint = false;     // drawn with little care
};

// One for each ghost and light, those first that come first in the plan.
[[nodiscard]] std::vector<Item> find_items(const Scene& scene, const Context& context, Work& work);

struct Painted {
  TiledPolygons polygons;
  Work work;
};

// Its boxes as wide as the light that its screens let through.
[[nodiscard]] Work widen_boxes(const Scene& scene, Item& item);

// What a small frame, drawn without care, tells.
struct ItemSize : Spread {
  double rays = 0;  // that it took
};

// An item in all wavelengths of its light. size: as a small frame tells.
[[nodiscard]] Painted paint_item(const Scene& scene, const Item& item, const ItemSize& size, const Frame& frame,
                                 const TileGrid& grid, const ErrorBudget& budget, Pool<BoxCells>& rooms);

struct RoughFrame {
  double peak = 0;  // what errors are relative to: the level that 99.9 per cent of samples stay below (metrics.h)
  std::vector<ItemSize> sizes;  // one an item; none when cancelled
};
[[nodiscard]] RoughFrame draw_roughly(const Scene& scene, const std::vector<Item>& items, const Frame& frame,
                                      Pool<BoxCells>& rooms, TileDrawer& drawer, const Context& context, Work& work);

}  // namespace contrejour::adaptive
