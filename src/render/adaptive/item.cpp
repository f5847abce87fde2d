#include "render/adaptive/item.h"

#include <algorithm>
#include <limits>

#include "base/tasks.h"
#include "contrejour/metrics.h"
#include "render/adaptive/pupil_boxes.h"

namespace contrejour::adaptive {
namespace {

constexpr double kMargin = 0.03;  // of a box's size, on every side
constexpr double kWidening = 0.2; // the same, where another wavelength needs more
constexpr int kMostWidenings = 4;
constexpr int kWideningNodes = 5;
constexpr int kDeepest = 4;       // quarterings of a box
constexpr int kPeakDeepest = 1;
constexpr double kPeakQuantile = 0.999;
constexpr int kPeakScale = 8;  // the frame's pixels over those of the small one, along a side

const PlannedPass& middle_pass(const PlannedLight& light) { return light.passes[light.passes.size() / 2]; }

// Whether light comes through at the very border of a sheet's box.
bool is_cut_off(const Scene& scene, const LightFrame& light, const RaySheet& sheet) {
  if (sheet.failed > 0) {
    const int last = sheet.nodes - 1;
    for (int k = 0; k < sheet.nodes * sheet.nodes; ++k) {
      const int x = k % sheet.nodes;
      const int y = k / sheet.nodes;
      if ((x == 0 || y == 0 || x == last || y == last) && is_open(sheet, static_cast<std::size_t>(k))) return true;
    }
    return false;
  }
  const Mesh mesh = make_mesh(make_patch(sheet, light, Frame{1, 1, 0, 0, 1, 1, 1.0}), scene.iris);
  for (int k = 0; k < Mesh::kSide; ++k) {
    for (const std::size_t v : {Mesh::at(k, 0), Mesh::at(k, Mesh::kCells), Mesh::at(0, k), Mesh::at(Mesh::kCells, k)}) {
      if (mesh.outside[v] == 0) return true;
    }
  }
  return false;
}

// A box found at one wavelength, wide enough for another. Boxes beside the axis of symmetry stay on their side.
Work widen(const Scene& scene, const Item& item, double lambda_nm, Rectangle& box) {
  const LightFrame light(item.light->direction);
  const EntranceWindow window = entrance_window(scene.lens, light.direction);
  const PlannedPass pass{lambda_nm, {}};
  SheetTracer tracer(scene.lens, item.ghost, light, window.z_mm, {lambda_nm, {&pass, 1}}, scene.plan.tables);
  for (int step = 0; step < kMostWidenings; ++step) {
    if (!is_cut_off(scene, light, tracer.trace(box, kWideningNodes, PacketPrecision::Double))) break;
    const Vec2 more = (box.high - box.low) * kWidening;
    const Rectangle before = box;
    box.low = {std::max(box.low.x - more.x, std::min(box.low.x, window.min_mm.x)), box.low.y - more.y};
    box.high = {std::min(box.high.x + more.x, std::max(box.high.x, window.max_mm.x)), box.high.y + more.y};
    if (before.low.y >= 0.0) box.low.y = std::max(box.low.y, 0.0);
    if (before.high.y <= 0.0) box.high.y = std::min(box.high.y, 0.0);
  }
  return {tracer.rays(), tracer.surface_hits()};
}

bool overlap(const Rectangle& a, const Rectangle& b) {
  return a.low.x < b.high.x && b.low.x < a.high.x && a.low.y < b.high.y && b.low.y < a.high.y;
}

// Boxes that overlap, which would be painted twice there, as one that holds both.
void merge_overlapping(std::vector<Rectangle>& boxes) {
  for (std::size_t a = 0; a < boxes.size(); ++a) {
    for (std::size_t b = a + 1; b < boxes.size(); ++b) {
      if (!overlap(boxes[a], boxes[b])) continue;
      boxes[a] = {{std::min(boxes[a].low.x, boxes[b].low.x), std::min(boxes[a].low.y, boxes[b].low.y)},
                  {std::max(boxes[a].high.x, boxes[b].high.x), std::max(boxes[a].high.y, boxes[b].high.y)}};
      boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(b));
      return merge_overlapping(boxes);
    }
  }
}

// Where rays get through, at all wavelengths of the light.
Work find_boxes(const Scene& scene, Item& item) {
  const LightFrame light(item.light->direction);
  const double lambda_nm = middle_pass(*item.light).lambda_nm;
  const OpticalPath path = ghost_path(scene.lens, item.ghost, lambda_nm);
  PupilBoxes found =
      find_pupil_boxes(path, *scene.plan.tables.at(lambda_nm), light, entrance_window(scene.lens, light.direction));
  for (Rectangle& box : found.boxes) {
    const Vec2 margin = (box.high - box.low) * kMargin;
    box = {box.low - margin, box.high + margin};
  }
  Work work{found.rays, found.rays * path.steps.size()};
  for (Rectangle& box : found.boxes) {
    work.add(widen(scene, item, item.light->passes.front().lambda_nm, box));
    work.add(widen(scene, item, item.light->passes.back().lambda_nm, box));
  }
  merge_overlapping(found.boxes);
  item.boxes = std::move(found.boxes);
  return work;
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
  for (int* length : {&small.width, &small.height, &small.full_width, &small.full_height})
    *length = std::max(1, *length / by);
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
