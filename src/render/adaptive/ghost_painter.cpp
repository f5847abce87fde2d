#include "render/adaptive/ghost_painter.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "render/adaptive/extremes.h"

namespace contrejour::adaptive {
namespace {

constexpr std::array kNodes{5, 9, 17};
// Float places a ray on the sensor to some 1e-3 mm at worst; it must be given room enough at the entrance, too.
constexpr double kFloatError_mm = 1e-3;
constexpr double kFloatBox_mm = 0.05;
constexpr double kCellsPerItem = 64.0; // an item's squared error is shared among so many cells

// Whether any cell between the nodes may let light through; the iris counts as its circumscribed circle.
bool may_pass(const RaySheet& sheet) {
  const auto n = static_cast<std::size_t>(sheet.nodes);
  for (std::size_t cell = 0; cell + n < sheet.count(); ++cell) {
    if (cell % n == n - 1) continue;
    std::array<Extremes, 1 + kMaxStopCrossings> extremes;
    bool any = false;
    for (const std::size_t k : {cell, cell + 1, cell + n, cell + n + 1}) {
      if (std::isinf(sheet.r_rel[k])) continue;
      any = true;
      extremes[0].add(sheet.r_rel[k] - 1.0F);
      for (std::size_t c = 0; c < sheet.stop.size(); ++c) {
        extremes[1 + c].add(std::hypot(sheet.stop[c][0][k], sheet.stop[c][1][k]) - 1.0F);
      }
    }
    for (std::size_t l = 0; l < 1 + sheet.stop.size(); ++l) any = any && extremes[l].may_pass(1.0F);
    if (any) return true;
  }
  return false;
}

}  // namespace

// How far a fit may be off, from what that does to pixels: edges displaced by d over a length of about 4 L, and
// levels off by a share w over L^2 pixels.
GhostPainter::Tolerance GhostPainter::tolerance_for(const RaySheet& sheet, const ErrorBudget& budget) const {
  if (!std::isfinite(budget.squared_error)) return {1e9, 1e9, 1e9};
  Vec2 low{1e30, 1e30};
  Vec2 high{-1e30, -1e30};
  double weight = 0.0;
  int arrived = 0;
  for (std::size_t k = 0; k < sheet.count(); ++k) {
    if (std::isinf(sheet.r_rel[k])) continue;
    ++arrived;
    const Vec2 p = Vec2{sheet.sensor_x_mm[k], sheet.sensor_y_mm[k]} * (1.0 / frame_.pixel_pitch_mm);
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    for (const auto& w : sheet.weight) weight = std::max(weight, std::abs(static_cast<double>(w[k])));
  }
  if (arrived == 0 || !(weight > 0.0)) return {1e9, 1e9, 1e9};
  const Vec2 size{std::max(high.x - low.x, 1.0), std::max(high.y - low.y, 1.0)};
  const double side = std::sqrt(size.x * size.y);
  const Vec2 pupil = sheet.box.high - sheet.box.low;
  const double level = std::min(weight * pupil.x * pupil.y * meridian_.direction.z / (size.x * size.y), 4.0 * budget.peak);
  const double error = std::sqrt(budget.squared_error) / level;  // in levels, summed
  Tolerance t;
  t.position_px = std::clamp(std::min(error / (2.0 * std::sqrt(side)), error / 8.0), 0.005, 0.05 * side + 0.5);
  t.stop = 2.0 * t.position_px / side;
  t.weight = std::clamp(error / side, 1e-4, 0.5);
  return t;
}

PacketPrecision GhostPainter::precision_for(const Rectangle& box, const Tolerance& tolerance) const {
  const bool coarse = tolerance.position_px * frame_.pixel_pitch_mm > 2.0 * kFloatError_mm;
  const Vec2 size = box.high - box.low;
  return coarse && std::min(size.x, size.y) > kFloatBox_mm ? PacketPrecision::Float : PacketPrecision::Double;
}

bool GhostPainter::accepts(const Patch& patch, const Tolerance& tolerance) {
  const PatchError e = estimated_error(patch);
  return e.position_px <= tolerance.position_px && e.stop <= tolerance.stop && e.rim <= 2.0 * tolerance.stop &&
         e.weight <= tolerance.weight;
}

void GhostPainter::paint(const PaintJob& job, const ErrorBudget& budget, PolygonList& out) {
  SheetTracer tracer(lens_, job.ghost, meridian_, plane_z_mm_, job.band, tables_);
  CellPainter cells(iris_, frame_, budget.squared_error / kCellsPerItem, budget.peak, out);
  const RaySheet first = tracer.trace(job.box, kNodes.front(), PacketPrecision::Double);
  const Tolerance tolerance = tolerance_for(first, budget);
  bool done = false;
  if (first.failed == 0) {
    const Patch patch = make_patch(first, meridian_, frame_);
    if (accepts(patch, tolerance)) {
      cells.paint(patch);
      done = true;
    }
  }
  if (!done) paint_box(tracer, job.box, 0, tolerance, cells);
  if (getenv("DBG")) { double rmin=1e9; for (float r: first.r_rel) rmin=std::min<double>(rmin,r); const PatchError e = first.failed?PatchError{}:estimated_error(make_patch(first,meridian_,frame_)); fprintf(stderr,"%d-%d %.0f box %g %g..%g  failed %d rays %d polys %zu tol px %.3g stop %.3g w %.3g  err5 %.3g %.3g %.3g %.3g rmin %.3g\n", job.ghost.i, job.ghost.j, job.band.lambda_nm, job.box.high.y, job.box.low.x, job.box.high.x, first.failed, (int)tracer.rays(), out.polygons.size(), tolerance.position_px, tolerance.stop, tolerance.weight, e.position_px,e.stop,e.rim,e.weight, rmin); }
  rays_ += tracer.rays();
  surface_hits_ += tracer.surface_hits();
}

void GhostPainter::paint_box(SheetTracer& tracer, const Rectangle& box, int depth, const Tolerance& tolerance,
                             CellPainter& cells) {
  for (std::size_t k = depth == 0 ? 1 : 0; k < kNodes.size(); ++k) {
    const RaySheet sheet = tracer.trace(box, kNodes[k], precision_for(box, tolerance));
    if (!may_pass(sheet)) return;
    const bool last = k + 1 == kNodes.size();
    if (sheet.failed == 0) {
      const Patch patch = make_patch(sheet, meridian_, frame_);
      if (accepts(patch, tolerance) || (last && depth >= deepest_)) return cells.paint(patch);
    } else if (depth >= deepest_) {
      return paint_sheet(sheet, cells);
    } else {
      break;
    }
  }
  paint_quarters(tracer, box, depth, tolerance, cells);
}

void GhostPainter::paint_quarters(SheetTracer& tracer, const Rectangle& box, int depth, const Tolerance& tolerance,
                                  CellPainter& cells) {
  const Vec2 middle = (box.low + box.high) * 0.5;
  for (const auto& [y0, y1] : {std::pair{box.low.y, middle.y}, std::pair{middle.y, box.high.y}}) {
    for (const auto& [x0, x1] : {std::pair{box.low.x, middle.x}, std::pair{middle.x, box.high.x}}) {
      paint_box(tracer, {{x0, y0}, {x1, y1}}, depth + 1, tolerance, cells);
    }
  }
}

// Cells between rays that arrived, as patches of four.
void GhostPainter::paint_sheet(const RaySheet& sheet, CellPainter& cells) const {
  const int n = sheet.nodes;
  const auto copy = [n](const auto& from, auto& to, int ix, int iy, std::size_t offset = 0) {
    for (int k = 0; k < 4; ++k) {
      to.push_back(from[offset + static_cast<std::size_t>((iy + k / 2) * n + ix + k % 2)]);
    }
  };
  const auto points = [&] {
    std::vector<double> p;
    for (int k = 0; k < n; ++k) p.push_back(0.5 - 0.5 * std::cos(3.14159265358979 * k / (n - 1)));
    return p;
  }();
  const Vec2 size = sheet.box.high - sheet.box.low;
  for (int iy = 0; iy + 1 < n; ++iy) {
    for (int ix = 0; ix + 1 < n; ++ix) {
      RaySheet cell;
      cell.nodes = 2;
      copy(sheet.r_rel, cell.r_rel, ix, iy);
      if (std::any_of(cell.r_rel.begin(), cell.r_rel.end(), [](float r) { return std::isinf(r); })) continue;
      const auto x = static_cast<std::size_t>(ix);
      const auto y = static_cast<std::size_t>(iy);
      cell.box = {{sheet.box.low.x + size.x * points[x], sheet.box.low.y + size.y * points[y]},
                  {sheet.box.low.x + size.x * points[x + 1], sheet.box.low.y + size.y * points[y + 1]}};
      copy(sheet.sensor_x_mm, cell.sensor_x_mm, ix, iy);
      copy(sheet.sensor_y_mm, cell.sensor_y_mm, ix, iy);
      for (std::size_t c = 0; c < 3; ++c) copy(sheet.weight[c], cell.weight[c], ix, iy);
      cell.stop.resize(sheet.stop.size());
      for (std::size_t c = 0; c < sheet.stop.size(); ++c) {
        copy(sheet.stop[c][0], cell.stop[c][0], ix, iy);
        copy(sheet.stop[c][1], cell.stop[c][1], ix, iy);
      }
      for (std::size_t step = 0; step * sheet.count() < sheet.rim_squared.size(); ++step) {
        copy(sheet.rim_squared, cell.rim_squared, ix, iy, step * sheet.count());
      }
      cells.paint(make_patch(cell, meridian_, frame_));
    }
  }
}

}  // namespace contrejour::adaptive
