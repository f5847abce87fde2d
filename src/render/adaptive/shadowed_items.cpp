#include "render/adaptive/shadowed_items.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace contrejour::adaptive {
namespace {

constexpr double kUnshadowedShare = 0.15;  // of the frame's squared error, that ghosts without shadows may make
constexpr double kRoom = 0.07;  // of an item's boxes, beside its light (item.cpp)

// In the plane of the dirt: about the box that the item's light crosses, mm.
Rectangle crossed(const Scene& scene, const Item& item) {
  const double r = scene.plan.dirt->stop_radius_mm();
  if (!scene.plan.dirt->on_front()) return {{-r, -r}, {r, r}};
  const LightFrame light(item.light->source, has_axial_symmetry(scene.lens, item.ghost));
  const SeenDirt seen{scene.plan.dirt.get(), &light, item.window.z_mm};
  Rectangle all{seen.front_place(item.boxes.front().low), seen.front_place(item.boxes.front().low)};
  for (const Rectangle& box : item.boxes) {
    for (const Vec2 corner : {box.low, box.high, Vec2{box.low.x, box.high.y}, Vec2{box.high.x, box.low.y}}) {
      const Vec2 p = seen.front_place(corner);
      all.low = {std::min(all.low.x, p.x), std::min(all.low.y, p.y)};
      all.high = {std::max(all.high.x, p.x), std::max(all.high.y, p.y)};
    }
  }
  const Vec2 room = (all.high - all.low) * kRoom;
  return {all.low + room, all.high - room};
}

// What an item without shadows differs from itself with them, squared, over its pixels.
double shadow_error(const Scene& scene, const Item& item, const ItemSize& size, double peak) {
  if (!(size.area_px > 0.0)) return std::numeric_limits<double>::infinity();  // a careless look did not find it
  const Rectangle box = crossed(scene, item);
  const double area_mm2 = 0.25 * std::numbers::pi * (box.high.x - box.low.x) * (box.high.y - box.low.y);
  const double seen = size.level * seen_share(size.level, peak);
  return seen * seen * size.area_px * scene.plan.dirt->variance(std::sqrt(area_mm2 / size.area_px));
}

}  // namespace

void dim_items(const Scene& scene, std::vector<Item>& items) {
  for (Item& item : items) {
    if (item.boxes.empty()) continue;
    const Rectangle box = crossed(scene, item);
    item.past_dirt = scene.plan.dirt->mean_within(box.low, box.high);
  }
}

void shadow_items(const Scene& scene, std::vector<Item>& items, const std::vector<ItemSize>& sizes,
                  const FrameError& allowed) {
  std::vector<std::size_t> lit;
  std::vector<double> error(items.size());
  for (std::size_t k = 0; k < items.size(); ++k) {
    if (items[k].boxes.empty()) continue;
    error[k] = shadow_error(scene, items[k], sizes[k], allowed.peak);
    lit.push_back(k);
  }
  for (const std::size_t k : worth_drawing(std::move(lit), error, kUnshadowedShare * allowed.squared()))
    items[k].has_shadows = true;
}

}  // namespace contrejour::adaptive
