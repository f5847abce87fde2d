#include "render/adaptive/item.h"

#include <algorithm>
#include <limits>

#include "base/tasks.h"
#include "contrejour/metrics.h"
#include "render/adaptive/pupil_boxes.h"

namespace contrejour::adaptive {
namespace {

constexpr double kMargin = 0.03;  // of a box's size, on every side, for the other wavelengths
constexpr int kDeepest = 4;       // quarterings of a box
constexpr int kPeakDeepest = 1;
constexpr double kPeakQuantile = 0.999;
constexpr int kPeakScale = 8;  // the frame's pixels over those of the small one, along a side

const PlannedPass& middle_pass(const PlannedLight& light) { return light.passes[light.passes.size() / 2]; }

// Where rays get through, at the middle wavelength.
Work find_boxes(const Scene& scene, Item& item) {
  const LightFrame light(item.light->direction);
  const double lambda_nm = middle_pass(*item.light).lambda_nm;
  const OpticalPath path = ghost_path(scene.lens, item.ghost, lambda_nm);
  PupilBoxes found = find_pupil_boxes(path, *scene.plan.tables.at(lambda_nm), light, entrance_window(scene.lens, light.direction));
  for (Rectangle& box : found.boxes) {
    const Vec2 margin = (box.high - box.low) * kMargin;
    box = {box.low - margin, box.high + margin};
  }
  item.boxes = std::move(found.boxes);
  return {found.rays, found.rays * path.steps.size()};
}

Painted paint(const Scene& scene, const Item& item, std::span<const PlannedPass> passes, const Frame& frame,
              const TileGrid& grid, const ErrorBudget& budget, int deepest) {
  Painted painted;
  const LightFrame light(item.light->direction);
  GhostPainter painter(scene.lens, scene.iris, frame, light, scene.plan.tables, deepest);
  for (const Rectangle& box : item.boxes) painter.paint(item.ghost, box, passes, budget, painted.polygons.list);
  painted.polygons.tiles = tile_lists(painted.polygons.list, grid);
  painted.work = {painter.rays(), painter.surface_hits()};
  return painted;
}

// All wavelengths as if they were the middle one.
PlannedPass merged(const PlannedLight& light) {
  PlannedPass all{middle_pass(light).lambda_nm, {}};
  for (const PlannedPass& pass : light.passes) {
    for (std::size_t c = 0; c < 3; ++c) all.gain[c] += pass.gain[c];
  }
  return all;
}

Frame smaller(const Frame& frame, int by) {
  Frame small = frame;
  for (int* length : {&small.width, &small.height, &small.full_width, &small.full_height}) *length = std::max(1, *length / by);
  small.origin_x /= by;
  small.origin_y /= by;
  small.pixel_pitch_mm *= by;
  return small;
}

}  // namespace

std::vector<Item> find_items(const Scene& scene, const Context& context, Work& work) {
  std::vector<Item> items;
  for (const Ghost& ghost : scene.plan.ghosts) {
    for (const PlannedLight& light : scene.plan.lights) items.push_back({ghost, &light, {}});
  }
  std::vector<Work> done(items.size());
  parallel_for(items.size(), context, [&](std::size_t k) { done[k] = find_boxes(scene, items[k]); });
  for (const Work& w : done) work.add(w);
  return items;
}

Painted paint_item(const Scene& scene, const Item& item, const Frame& frame, const TileGrid& grid,
                   const ErrorBudget& budget) {
  return paint(scene, item, item.light->passes, frame, grid, budget, kDeepest);
}

double estimate_peak(const Scene& scene, const std::vector<Item>& items, const Frame& frame, const Context& context,
                     Work& work) {
  const Frame small = smaller(frame, kPeakScale);
  const TileGrid grid(small.width, small.height);
  const ErrorBudget unlimited{std::numeric_limits<double>::infinity(), 1.0};
  std::vector<TiledPolygons> polygons(items.size());
  std::vector<Work> done(items.size());
  parallel_for(items.size(), context, [&](std::size_t k) {
    const PlannedPass pass = merged(*items[k].light);
    Painted painted = paint(scene, items[k], {&pass, 1}, small, grid, unlimited, kPeakDeepest);
    polygons[k] = std::move(painted.polygons);
    done[k] = painted.work;
  });
  for (const Work& w : done) work.add(w);
  if (context.cancelled()) return 0.0;
  Image image(small.width, small.height, 3);
  for (int row = 0; row < grid.rows; ++row) add_tile_row(polygons, grid, row, image);
  double peak = quantile_of_samples(image, kPeakQuantile);
  if (!(peak > 0.0)) {
    for (const float value : image.pixels) peak = std::max(peak, static_cast<double>(value));
  }
  return peak / (kPeakScale * kPeakScale);
}

}  // namespace contrejour::adaptive
