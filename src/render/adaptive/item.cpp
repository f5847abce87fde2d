#include "render/adaptive/item.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/tasks.h"
#include "contrejour/metrics.h"
#include "ghosts/pupil_search.h"
#include "render/adaptive/cells/shared_edges.h"
#include "render/adaptive/pupils/box_fit.h"
#include "render/adaptive/pupils/pupil_boxes.h"

namespace contrejour::adaptive {
namespace {

// Of a box's size, on every side: polynomials through its rays are least good at its border, where the ghost's edge
// would be if the box were tight. Half of this saves no rays and costs a decibel; twice this takes a third more rays.
constexpr double kMargin = 0.1;
constexpr int kDeepest = 4;       // quarterings of a box
// Boxes of the sharp stop are widened as the stop is up to here, farther by its root: what they lack they grow.
constexpr double kMuchWider = 1.5;
// Of an item's squared error, behind screens: cells come closer to theirs there.
constexpr double kScreenedShare = 0.75;
constexpr int kPeakDeepest = 1;
constexpr double kPeakQuantile = 0.999;
// The frame's pixels over those of the small one, along a side: where the small one has so many, no more.
constexpr int kMostPeakScale = 8;
constexpr double kPeakPixels = 2500.0;

const PlannedPass& middle_pass(const PlannedLight& light) { return light.passes[light.passes.size() / 2]; }

bool overlap(const Rectangle& a, const Rectangle& b) {
  return a.low.x < b.high.x && b.low.x < a.high.x && a.low.y < b.high.y && b.low.y < a.high.y;
}

// Boxes that overlap, which would be painted twice there, as one that holds both.
void merge_overlapping(std::vector<Rectangle>& boxes) {
  for (std::size_t a = 0; a < boxes.size(); ++a) {
    for (std::size_t b = a + 1; b < boxes.size(); ++b) {
      if (!overlap(boxes[a], boxes[b])) continue;
      boxes[a] = both(boxes[a], boxes[b]);
      boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(b));
      return merge_overlapping(boxes);
    }
  }
}

Rectangle with_margin(const Rectangle& box) {
  const Vec2 margin = (box.high - box.low) * kMargin;
  Rectangle out{box.low - margin, box.high + margin};
  return out;
}

// Likewise, of a box of a symmetric pupil: it stays on its side of the axis of symmetry.
Rectangle with_margin_aside(const Rectangle& box) {
  Rectangle out = with_margin(box);
  if (box.low.y >= 0.0) out.low.y = std::max(out.low.y, 0.0);
  return out;
}

// So many times as large; one of a symmetric pupil stays on its side of the axis of symmetry.
Rectangle about_middle(const Rectangle& box, double times) {
  const Vec2 more = (box.high - box.low) * (0.5 * (times - 1.0));
  Rectangle out{box.low - more, box.high + more};
  if (box.low.y >= 0.0) out.low.y = std::max(out.low.y, 0.0);
  return out;
}

// Of a box on the other side of the axis of symmetry.
bool is_mirror_image(const Rectangle& box) { return box.high.y <= 0.0; }

// The wavelengths at which a pupil is searched that is to hold for all.
std::vector<double> outer_wavelengths(const PlannedLight& light) {
  std::vector<double> outer_nm{light.passes.front().lambda_nm};
  if (light.passes.size() > 1) outer_nm.push_back(light.passes.back().lambda_nm);
  return outer_nm;
}

// Where the item has screens the stop counts as larger, to hold the light beside its opening.
double stop_times(const Item& item) { return item.screens ? item.screens->reach : 1.0; }

// Of a lens without symmetries: one box, by grids over all of the window.
Work find_askew_box(const Scene& scene, Item& item) {
  const LightSource& light = item.light->source;
  const IrisShape circle{Iris{}};
  Work work;
  RayGrid grid;
  std::optional<Rectangle> box;
  for (const double lambda_nm : outer_wavelengths(*item.light)) {
    const OpticalPath path = widened(ghost_path(scene.lens, item.ghost, lambda_nm), stop_times(item));
    const auto region = find_pupil_region(path, *scene.plan.tables.at(lambda_nm), circle, light, item.window, grid);
    if (!region) continue;
    box = box ? both(*box, region->pupil_mm) : region->pupil_mm;
    work.add({region->rays, region->rays * path.steps.size()});
  }
  if (box) item.boxes.push_back(with_margin(*box));
  return work;
}

// What comes through near some boxes, at all wavelengths of the light; mirror images are left to their originals.
Work fit_boxes(const Scene& scene, Item& item, const std::vector<Rectangle>& near) {
  const LightFrame light(item.light->source);
  const LightRays rays{{0.0, 0.0, item.window.z_mm}, light.source};
  std::vector<std::optional<Rectangle>> fitted(near.size());
  Work work;
  for (const double lambda_nm : outer_wavelengths(*item.light)) {
    BoxFitter fitter({scene.steps.at(lambda_nm), item.ghost, rays, stop_times(item)}, item.window);
    for (std::size_t k = 0; k < near.size(); ++k) {
      const auto fit = fitter.fit(near[k]);
      if (fit) fitted[k] = fitted[k] ? both(*fitted[k], *fit) : *fit;
    }
    work.add({fitter.rays(), fitter.surface_hits()});
  }
  for (std::size_t k = 0; k < near.size(); ++k) {
    Rectangle box = fitted[k].value_or(near[k]);
    if (box.low.y < 0.0) box.low.y = -box.high.y;
    item.boxes.push_back(box);
    if (box.low.y >= 0.0) item.boxes.push_back({{box.low.x, -box.high.y}, {box.high.x, -box.low.y}});
  }
  merge_overlapping(item.boxes);
  return work;
}

// Where rays get through: found at the middle wavelength, then fitted to the outer ones.
Work find_boxes(const Scene& scene, Item& item) {
  if (!has_axial_symmetry(scene.lens, item.ghost)) return find_askew_box(scene, item);
  const LightFrame light(item.light->source);
  const double middle_nm = middle_pass(*item.light).lambda_nm;
  const PacketPath path(scene.steps.at(middle_nm), item.ghost, {{0.0, 0.0, item.window.z_mm}, light.source});
  const PupilBoxes found = find_pupil_boxes(path, item.window);
  Work work{found.rays, found.rays * path.steps().size()};
  std::vector<Rectangle> near;
  for (const Rectangle& box : found.boxes)
    if (!is_mirror_image(box)) near.push_back(with_margin_aside(box));
  if (!near.empty()) work.add(fit_boxes(scene, item, near));
  return work;
}

}  // namespace

Work widen_boxes(const Scene& scene, Item& item) {
  std::vector<Rectangle> sharp = std::exchange(item.boxes, {});
  if (!has_axial_symmetry(scene.lens, item.ghost)) return find_askew_box(scene, item);
  std::erase_if(sharp, is_mirror_image);
  const double times = std::min(stop_times(item), std::sqrt(kMuchWider * stop_times(item)));
  for (Rectangle& box : sharp) box = about_middle(box, times);
  return fit_boxes(scene, item, sharp);
}

namespace {

const IrisShape& round_iris() {
  static const IrisShape circle{Iris{}};
  return circle;
}

// Those of an item's light.
std::vector<PlannedPass> passes_of(const Item& item) {
  std::vector<PlannedPass> passes = item.light->passes;
  for (PlannedPass& pass : passes) {
    pass.gain = item.look->tinted(pass.gain);
    for (double& gain : pass.gain) gain *= item.has_shadows ? 1.0 : item.past_dirt;
  }
  return passes;
}

// Of a wavelength's light, by a ghost's surfaces, about.
double reflected(const Ghost& ghost, const ReflectanceTables& tables) {
  double share = 1.0;
  for (const int surface : {ghost.i, ghost.j, ghost.k, ghost.l})
    if (surface > 0) share *= tables.near_normal(surface - 1);
  return share;
}

// All on the middle one's way. How much of each is reflected counts: films reflect the middle one least, whose light in
// place of theirs would be a third of the peak.
PlannedPass merged(const Scene& scene, const Item& item, std::span<const PlannedPass> passes) {
  const auto by = [&](const PlannedPass& pass) { return reflected(item.ghost, *scene.plan.tables.at(pass.lambda_nm)); };
  const PlannedPass& middle = passes[passes.size() / 2];
  const double by_middle = by(middle);
  PlannedPass all{middle.lambda_nm, {}};
  for (const PlannedPass& pass : passes) {
    const double times = by_middle > 0.0 ? by(pass) / by_middle : 1.0;
    for (std::size_t c = 0; c < 3; ++c) all.gain[c] += times * pass.gain[c];
  }
  return all;
}

// Rough: with little care, and all wavelengths on the way of one.
enum class Care { Rough, Little, Much };

Painted paint(const Scene& scene, const Item& item, Care care, const Frame& whole, const TileGrid& grid,
              const ErrorBudget& budget, Pool<BoxCells>& rooms) {
  Painted painted;
  const Frame frame = item.look->placed(whole);
  const LightFrame light(item.light->source, has_axial_symmetry(scene.lens, item.ghost));
  const IrisShape& iris = item.screens ? round_iris() : scene.iris;
  std::vector<PlannedPass> passes = passes_of(item);
  if (care == Care::Rough) passes = {merged(scene, item, passes)};
  GhostTracers tracers(scene.steps, item.ghost, light, item.window.z_mm, passes, stop_times(item));
  const auto room = rooms.lend();
  GhostPainter painter(tracers, iris, frame, care == Care::Much ? kDeepest : kPeakDeepest, *room, item.screens.get(),
                       item.has_shadows ? scene.plan.dirt.get() : nullptr);
  for (const Rectangle& box : item.boxes) {
    const bool aside = light.symmetric && box.low.y != -box.high.y;
    const bool has_image = aside && std::ranges::count(item.boxes, mirrored(box)) > 0;
    if (has_image && is_mirror_image(box)) continue;  // painted with the other
    painter.paint(box, has_image, budget, painted.polygons.list);
  }
  share_edges(painted.polygons.list, grid);
  painted.polygons.tiles = tile_lists(painted.polygons.list, grid);
  painted.work = {tracers.rays(), tracers.surface_hits()};
  return painted;
}

// In pixels of the whole frame.
Spread spread_of(const PolygonList& list, int scale) {
  const double pixels = scale * scale;
  const double least_px = 1.0 / pixels;
  double light = 0.0, squares = 0.0;
  for (const Polygon& polygon : list.polygons) {
    const double polygon_px = 0.5 * std::abs(twice_signed_area(list.corners_of(polygon)));
    const auto& v = polygon.shade.value;
    const double here = polygon_px * std::sqrt((v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) / 3.0);
    light += here;
    squares += here * here / std::max(polygon_px, least_px);
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
    items.push_back(
        {ghost, &scene.plan.looks[g], &lights[k], windows[k].of(has_axial_symmetry(scene.lens, ghost)), {}});
  });
  std::vector<Work> done(items.size());
  parallel_for(items.size(), context, [&](std::size_t k) { done[k] = find_boxes(scene, items[k]); });
  for (const Work& w : done) work.add(w);
  return items;
}

Painted paint_item(const Scene& scene, const Item& item, const ItemSize& size, const Frame& frame, const TileGrid& grid,
                   const ErrorBudget& budget, Pool<BoxCells>& rooms) {
  ErrorBudget of_item = budget;
  of_item.about = size;
  if (item.screens) of_item.squared_error *= kScreenedShare;
  if (item.is_faint) of_item.squared_error = std::numeric_limits<double>::infinity();
  return paint(scene, item, item.is_faint ? Care::Little : Care::Much, frame, grid, of_item, rooms);
}

RoughFrame draw_roughly(const Scene& scene, const std::vector<Item>& items, const Frame& frame, Pool<BoxCells>& rooms,
                        TileDrawer& drawer, const Context& context, Work& work) {
  const double pixels = static_cast<double>(frame.width) * frame.height;
  const int scale = std::clamp(static_cast<int>(std::sqrt(pixels / kPeakPixels)), 1, kMostPeakScale);
  const Frame small = smaller(frame, scale);
  const TileGrid grid(small.width, small.height);
  // No level is high beside a peak that is not known yet, whatever the light's value.
  constexpr double kUnknown = std::numeric_limits<double>::infinity();
  const ErrorBudget unlimited{kUnknown, kUnknown};
  std::vector<TiledPolygons> polygons(items.size());
  std::vector<Work> done(items.size());
  RoughFrame rough;
  rough.sizes.resize(items.size());
  parallel_for(items.size(), context, [&](std::size_t k) {
    Painted painted = paint(scene, items[k], Care::Rough, small, grid, unlimited, rooms);
    polygons[k] = std::move(painted.polygons);
    done[k] = painted.work;
    rough.sizes[k] = {spread_of(polygons[k].list, scale), static_cast<double>(done[k].rays)};
  });
  for (const Work& w : done) work.add(w);
  if (context.cancelled()) return {};
  Image image = Image::unwritten(small.width, small.height);
  drawer.draw(polygons, TileMode::Write, context, image);
  if (context.cancelled()) return {};
  rough.peak = quantile_of_samples(image, kPeakQuantile);
  if (!(rough.peak > 0.0)) {
    for (const float value : image.pixels) rough.peak = std::max(rough.peak, static_cast<double>(value));
  }
  rough.peak /= scale * scale;
  return rough;
}

}  // namespace contrejour::adaptive
