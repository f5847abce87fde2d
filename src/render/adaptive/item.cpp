// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/item.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>

#include "base/tasks.h"
#include "contrejour/expert/metrics.h"
#include "render/adaptive/budget/preview.h"
#include "render/adaptive/emit/shared_edges.h"
#include "render/pupils/fitted_pupil.h"
#include "render/pupils/ghost_pupil.h"

namespace contrejour::inline internal::adaptive {
namespace {

std::vector<double> wavelengths_of(const PlannedLight& light) {
  std::vector<double> lambda_nm;
  for (const PlannedPass& pass : light.passes) lambda_nm.push_back(pass.lambda_nm);
  return lambda_nm;
}

// An item with stop patterns is traced through an enlarged stop, to include the light outside the opening.
double stop_times(const Item& item) { return item.patterns ? item.patterns->outer_radius : 1.0; }

PupilRequest request_of(const Scene& scene, const Item& item, std::span<const double> lambda_nm) {
  return {scene.steps, item.ghost, item.light->source, item.window, lambda_nm, stop_times(item), scene.context};
}

Work take_boxes(Item& item, GhostPupil pupil) {
  item.boxes = std::move(pupil.boxes);
  return {pupil.rays, pupil.surface_hits};
}

// The item's fit; null where its rays must be traced.
std::unique_ptr<FittedGhost> fit_of(const Scene& scene, const Item& item, const LightFrame& light) {
  const std::vector<PlannedPass>& passes = item.light->passes;
  if (scene.fitted == nullptr || passes.empty()) return nullptr;
  return scene.fitted->find({item.ghost, light, item.window.z_mm, scene.lens.stop_radius_mm * stop_times(item),
                             passes.front().lambda_nm, passes.back().lambda_nm});
}

// Finds the boxes of a fitted item; false if it is traced.
bool find_fitted_boxes(const Scene& scene, Item& item, std::span<const double> lambda_nm) {
  const LightFrame light(item.light->source, has_axial_symmetry(scene.lens, item.ghost));
  const std::unique_ptr<FittedGhost> fitted = fit_of(scene, item, light);
  item.is_fitted = fitted != nullptr;
  if (fitted) item.boxes = find_fitted_pupil(*fitted, lambda_nm);
  return item.is_fitted;
}

// known: the item's pupil if the selection found it, else null.
Work find_boxes(const Scene& scene, Item& item, const GhostPupil* known) {
  const std::vector<double> lambda_nm = wavelengths_of(*item.light);
  if (find_fitted_boxes(scene, item, lambda_nm)) return {};
  if (known != nullptr) return take_boxes(item, *known);
  return take_boxes(item, scene.plan.kept_pupils->find_ghost_pupil(request_of(scene, item, lambda_nm)));
}

}  // namespace

Work widen_boxes(const Scene& scene, Item& item) {
  const std::vector<double> lambda_nm = wavelengths_of(*item.light);
  const bool was_fitted = item.is_fitted;
  if (was_fitted && find_fitted_boxes(scene, item, lambda_nm)) return {};
  const PupilRequest request = request_of(scene, item, lambda_nm);
  Work work;
  if (was_fitted) {  // the fit does not extend to the enlarged stop
    PupilRequest sharp = request;
    sharp.stop_times = 1.0;
    work = take_boxes(item, scene.plan.kept_pupils->find_ghost_pupil(sharp));
  }
  work.add(take_boxes(item, scene.plan.kept_pupils->refit_ghost_pupil(request, std::move(item.boxes))));
  return work;
}

namespace {

const IrisShape& round_iris() {
  static const IrisShape circle{Iris{}};
  return circle;
}

// The passes of an item's light, with its gains.
std::vector<PlannedPass> passes_of(const Item& item) {
  std::vector<PlannedPass> passes = item.light->passes;
  for (std::size_t k = 0; k < passes.size(); ++k) {
    passes[k].gain = item.adjustment->tinted(passes[k].gain);
    const auto& shadows = item.shadows;
    const double dirt_transmittance =
        shadows.empty() ? item.dirt_transmittance : shadows[std::min(k, shadows.size() - 1)]->level();
    for (double& gain : passes[k].gain) gain *= dirt_transmittance;
  }
  return passes;
}

// Merges all passes into the middle one. Each gain is scaled by the ratio of reflectances, since films reflect least at
// the middle wavelength: without the ratios the peak would be a third of what it is.
PlannedPass merged(const Scene& scene, const Item& item, std::span<const PlannedPass> passes) {
  const auto by = [&](const PlannedPass& pass) { return scene.plan.reflectances.of(item.ghost, pass.lambda_nm); };
  const PlannedPass& middle = passes[passes.size() / 2];
  const double by_middle = by(middle);
  PlannedPass all{middle.lambda_nm, {}};
  for (const PlannedPass& pass : passes) {
    const double times = by_middle > 0.0 ? by(pass) / by_middle : 1.0;
    for (std::size_t c = 0; c < 3; ++c) all.gain[c] += times * pass.gain[c];
  }
  return all;
}

// A fitted item counts as a typical traced one, which takes 92 to 111 rays on average (nikon-80-200). The number of
// rays that it takes says little, since none of them fails.
constexpr double kRaysOfFitted = 100.0;

// Preview: the rays of one wavelength serve for all.
enum class Quality { Preview, Low, Full };

TessellatedItem tessellate(const Scene& scene, const Item& item, Quality quality, const Frame& whole,
                           const ErrorBudget& budget, Pool<BoxCells>& scratch_pool) {
  TessellatedItem tessellated;
  const Frame frame = item.adjustment->placed(whole);
  const LightFrame light(item.light->source, has_axial_symmetry(scene.lens, item.ghost));
  const IrisShape& iris = item.patterns ? round_iris() : scene.iris;
  std::vector<PlannedPass> passes = passes_of(item);
  if (quality == Quality::Preview) passes = {merged(scene, item, passes)};
  const std::unique_ptr<FittedGhost> fitted = item.is_fitted ? fit_of(scene, item, light) : nullptr;
  GhostTracers tracers(scene.steps, item.ghost, light, item.window.z_mm, passes, stop_times(item), fitted.get());
  const auto scratch = scratch_pool.lend();
  GhostTessellator tessellator(tracers, iris, frame, quality == Quality::Full ? kMaxDepth : kPeakMaxDepth, *scratch,
                               item.patterns.get(), item.shadows);
  tessellator.stop_with(scene.context);
  for (const Rectangle& box : item.boxes) {
    const bool off_axis = light.symmetric && box.low.y != -box.high.y;
    const bool has_image = off_axis && std::ranges::count(item.boxes, mirrored(box)) > 0;
    if (has_image && is_mirror_image(box)) continue;  // tessellated together with the other box
    tessellator.tessellate(box, has_image, budget, tessellated.polygons);
  }
  share_edges(tessellated.polygons, whole.width, whole.height);
  tessellated.work = {tracers.traced_rays(), tracers.surface_hits()};
  tessellated.rays = tracers.rays();
  return tessellated;
}

// Counts the pieces of each item's light whose ghosts are drawn together.
void count_pieces(std::vector<Item>& items) {
  std::map<std::pair<Ghost, std::size_t>, std::size_t> pieces;
  for (const Item& item : items) ++pieces[{item.ghost, item.light->index}];
  for (Item& item : items) item.pieces = pieces.at({item.ghost, item.light->index});
}

// The level and the area of a list of polygons, in pixels of the whole frame. A polygon that lies in one pixel is a
// point, whose values are its flux.
LevelEstimate level_of(const PolygonList& list, int scale) {
  const double pixels = scale * scale;
  const double min_px = 1.0 / pixels;
  double light = 0.0, squares = 0.0;
  for (const Polygon& polygon : list.polygons) {
    const auto corners = list.corners_of(polygon);
    const double polygon_px = 0.5 * std::abs(twice_signed_area(corners));
    const auto& v = list.irradiance_of(polygon).value;
    const double rms = std::sqrt((v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) / 3.0);
    const double here = corners.size() == 1 ? rms : polygon_px * rms;
    light += here;
    squares += here * here / std::max(polygon_px, min_px);
  }
  if (!(squares > 0.0)) return {};
  return {squares / light / pixels, light * light / squares * pixels};
}

Frame smaller(const Frame& frame, int by) {
  Frame small = frame;
  for (int* length : {&small.width, &small.height, &small.full_width, &small.full_height})
    *length = std::max(1, *length / by);
  small.origin_x /= by;
  small.origin_y /= by;
  small.pixel_pitch_mm *= by;
  return small;
}

}  // namespace

std::vector<Item> find_items(const Scene& scene, const Context& context, Work& work) {
  const std::vector<PlannedLight>& lights = scene.plan.lights;
  std::vector<LightWindows> windows;
  for (const PlannedLight& light : lights) windows.emplace_back(scene.lens, light.source);
  std::vector<Item> items;
  for_each_pair(scene.plan, [&](std::size_t g, std::size_t k) {
    const Ghost& ghost = scene.plan.ghosts[g];
    items.push_back({ghost,
                     &scene.plan.adjustments[g],
                     &lights[k],
                     windows[k].of(has_axial_symmetry(scene.lens, ghost)),
                     scene.plan.layer_of(g, k),
                     1,
                     {}});
  });
  count_pieces(items);
  std::vector<Work> done(items.size());
  const std::vector<GhostPupil>& known = scene.plan.pupils;
  parallel_for(items.size(), context,
               [&](std::size_t k) { done[k] = find_boxes(scene, items[k], known.empty() ? nullptr : &known[k]); });
  for (const Work& w : done) work.add(w);
  return items;
}

TessellatedItem tessellate_item(const Scene& scene, const Item& item, const ItemEstimate& estimate, const Frame& frame,
                                const ErrorBudget& budget, Pool<BoxCells>& scratch_pool) {
  ErrorBudget of_item = budget_of(estimate, item.patterns != nullptr, item.is_negligible, budget);
  of_item.pieces = item.pieces;
  return tessellate(scene, item, item.is_negligible ? Quality::Low : Quality::Full, frame, of_item, scratch_pool);
}

PreviewFrame draw_preview(const Scene& scene, const std::vector<Item>& items, const Frame& frame,
                          Pool<BoxCells>& scratch_pool, Rasteriser& rasteriser, const Context& context, Work& work) {
  const int scale = preview_scale(frame);
  const Frame small = smaller(frame, scale);
  // While the peak is not known no level is high relative to it, whatever the light's value.
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  const ErrorBudget unlimited{kUnknown, kUnknown};
  const std::unique_ptr<PolygonBatch> batch = rasteriser.new_batch(small.width, small.height, nullptr);
  batch->extend(items.size());
  std::vector<Work> done(items.size());
  PreviewFrame preview;
  preview.estimates.resize(items.size());
  parallel_for(items.size(), context, [&](std::size_t k) {
    TessellatedItem tessellated = tessellate(scene, items[k], Quality::Preview, small, unlimited, scratch_pool);
    done[k] = tessellated.work;
    preview.estimates[k] = {level_of(tessellated.polygons, scale),
                            items[k].is_fitted ? kRaysOfFitted : static_cast<double>(tessellated.rays)};
    batch->set(k, std::move(tessellated.polygons));
  });
  for (const Work& w : done) work.add(w);
  if (context.cancelled()) return {};
  Image image = Image::unwritten(small.width, small.height);
  batch->draw(RasterMode::Write, context, {image});
  if (context.cancelled()) return {};
  preview.peak = quantile_of_samples(image, kPeakQuantile);
  if (!(preview.peak > 0.0)) {
    for (const float value : image.pixels) preview.peak = std::max(preview.peak, static_cast<double>(value));
  }
  preview.peak /= scale * scale;
  return preview;
}

}  // namespace contrejour::inline internal::adaptive
