// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/shadowed_items.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "render/adaptive/patterned_items.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kUnshadowedFraction = 0.15;  // of the frame's squared error: for ghosts drawn without shadows
constexpr double kBlurOfUnit = 0.5;  // of a fringe's width: narrower shapes are blurred at least to this width
constexpr double kBoxMargin = 0.07;  // of an item's boxes: margin around its light (item.cpp)

// The box in the plane of the dirt that the item's light crosses, approximately, in mm.
Rectangle crossed(const Scene& scene, const Item& item) {
  const double r = scene.plan.dirt->site().stop_radius_mm;
  if (!scene.plan.dirt->site().on_front) return {{-r, -r}, {r, r}};
  const LightFrame light(item.light->source, has_axial_symmetry(scene.lens, item.ghost));
  const auto visible = [&](Vec2 entrance) {
    return front_point_of(scene.plan.dirt->site(), light, item.window.z_mm, entrance);
  };
  Rectangle all{visible(item.boxes.front().low), visible(item.boxes.front().low)};
  for (const Rectangle& box : item.boxes) {
    for (const Vec2 corner : {box.low, box.high, Vec2{box.low.x, box.high.y}, Vec2{box.high.x, box.low.y}}) {
      const Vec2 p = visible(corner);
      all.low = {std::min(all.low.x, p.x), std::min(all.low.y, p.y)};
      all.high = {std::max(all.high.x, p.x), std::max(all.high.y, p.y)};
    }
  }
  const Vec2 margin = (all.high - all.low) * kBoxMargin;
  return {all.low + margin, all.high - margin};
}

// The squared difference that leaving out an item's shadows makes, summed over its pixels.
double shadow_error(const Scene& scene, const StopTransmittances& stops, const Item& item, const ItemEstimate& estimate,
                    double peak) {
  if (!(estimate.area_px > 0.0)) return std::numeric_limits<double>::infinity();  // the preview frame did not show it
  const Rectangle box = crossed(scene, item);
  const double area_mm2 = 0.25 * std::numbers::pi * (box.high.x - box.low.x) * (box.high.y - box.low.y);
  const double visible = estimate.level * peak_limited_weight(estimate.level, peak);
  const PlannedPass& pass = item.light->passes[item.light->passes.size() / 2];
  const StopTransmittances::Request wanted{item.ghost, pass.lambda_nm, pass.spread_nm, item.light->source};
  const double blur_mm = kBlurOfUnit * stops.dirt_fringe_unit_mm(wanted);
  return visible * visible * estimate.area_px *
         scene.plan.dirt->variance(std::max(std::sqrt(area_mm2 / estimate.area_px), blur_mm));
}

// Returns a single one for all passes if shadows are sharp at every wavelength.
std::vector<std::shared_ptr<const DirtShadows>> shadows_of(const StopTransmittances& stops, const Item& item) {
  std::vector<std::shared_ptr<const DirtShadows>> shadows;
  bool all_sharp = true;
  for (const PlannedPass& pass : passes_with_patterns(item.light->passes)) {
    shadows.push_back(stops.dirt_of(item.ghost, pass.lambda_nm, item.light->source));
    all_sharp = all_sharp && shadows.back()->is_sharp();
  }
  if (all_sharp) shadows.resize(1);
  return shadows;
}

}  // namespace

void dim_items(const Scene& scene, std::vector<Item>& items) {
  for (Item& item : items) {
    if (item.boxes.empty()) continue;
    const Rectangle box = crossed(scene, item);
    item.dirt_transmittance = scene.plan.dirt->mean_within(box.low, box.high);
  }
}

void shadow_items(const Scene& scene, StopTransmittances& stops, std::vector<Item>& items,
                  const std::vector<ItemEstimate>& estimates, const FrameError& allowed, const Context& context) {
  std::vector<std::size_t> lit;
  std::vector<double> error(items.size());
  for (std::size_t k = 0; k < items.size(); ++k) {
    if (items[k].boxes.empty()) continue;
    error[k] = shadow_error(scene, stops, items[k], estimates[k], allowed.peak);
    lit.push_back(k);
  }
  const auto chosen = above_error_limit(std::move(lit), error, kUnshadowedFraction * allowed.squared());
  std::vector<StopTransmittances::Request> wanted;
  for (const std::size_t k : chosen)
    for (const PlannedPass& pass : passes_with_patterns(items[k].light->passes))
      wanted.push_back({items[k].ghost, pass.lambda_nm, pass.spread_nm, items[k].light->source});
  if (!stops.prepare_dirt(wanted, context)) return;
  for (const std::size_t k : chosen) items[k].shadows = shadows_of(stops, items[k]);
}

}  // namespace contrejour::inline internal::adaptive
