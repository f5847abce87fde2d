#include "render/adaptive/ghost_painter.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "render/adaptive/extremes.h"
#include "render/adaptive/lobatto.h"
#include "render/screens/ringing_patterns.h"

namespace contrejour::adaptive {
namespace {

constexpr std::array kNodes{5, 9, 17};
// Float places a ray on the sensor to some 1e-3 mm at worst; it must be given room enough at the entrance, too.
constexpr double kFloatError_mm = 1e-3;
constexpr double kFloatBox_mm = 0.05;
constexpr double kWorthShrinking = 0.5;  // a box whose lit part has no more of its area is shrunk to it
constexpr double kFitShare = 0.4;  // of the allowed error, that fits may make: theirs is the same all over a ghost
constexpr double kNoLimit = 1e9;
constexpr double kPeaks = 4.0;  // fits of what is so many times brighter than the peak need be no better
constexpr float kNearlyThrough = 1.2F;  // of the clear height
constexpr double kShiftShare = 1.0;  // of a fit's tolerance that a band of wavelengths may take on either side
constexpr double kLightLeft = 0.05;  // of a channel's absolute sum over wavelengths, for its parts to mean anything
constexpr double kFewCells = 64.0;  // a band's squared error is shared among so many cells

// Bounds of the cells between the nodes that may let light through, none if none may; the iris counts as its
// circumscribed circle.
std::optional<Rectangle> lit_part(const RaySheet& sheet) {
  const auto n = static_cast<std::size_t>(sheet.nodes);
  const auto points = lobatto_points(sheet.nodes);
  const Vec2 half = (sheet.box.high - sheet.box.low) * 0.5;
  std::optional<Rectangle> part;
  for (std::size_t cell = 0; cell + n < sheet.count(); ++cell) {
    const std::size_t ix = cell % n;
    const std::size_t iy = cell / n;
    if (ix == n - 1) continue;
    std::array<Extremes, 1 + kMaxStopCrossings> extremes;
    bool any = false;
    for (const std::size_t k : {cell, cell + 1, cell + n, cell + n + 1}) {
      if (std::isinf(sheet.r_rel[k])) continue;
      any = true;
      extremes[0].add(sheet.r_rel[k] - 1.0F);
      for (std::size_t c = 0; c < sheet.stop.size(); ++c) {
        const float x = sheet.stop[c][0][k];
        const float y = sheet.stop[c][1][k];
        extremes[1 + c].add(std::sqrt(x * x + y * y) - 1.0F);
      }
    }
    for (std::size_t l = 0; l < 1 + sheet.stop.size(); ++l) any = any && extremes[l].may_pass(1.0F);
    if (!any) continue;
    const Vec2 low = sheet.box.low + Vec2{half.x * (1.0 + points[ix]), half.y * (1.0 + points[iy])};
    const Vec2 high = sheet.box.low + Vec2{half.x * (1.0 + points[ix + 1]), half.y * (1.0 + points[iy + 1])};
    if (!part) part = {low, high};
    part->low = {std::min(part->low.x, low.x), std::min(part->low.y, low.y)};
    part->high = {std::max(part->high.x, high.x), std::max(part->high.y, high.y)};
  }
  return part;
}

// A band's wavelengths as at most three of them, each with the gains of those nearest: within a band the rest would
// show no more.
std::vector<PlannedPass> thinned(std::span<const PlannedPass> passes) {
  const std::size_t count = std::min<std::size_t>(passes.size(), 3);
  std::vector<PlannedPass> few;
  for (std::size_t part = 0; part < count; ++part) {
    const std::size_t first = part * passes.size() / count;
    const std::size_t last = (part + 1) * passes.size() / count;
    PlannedPass one{passes[(first + last) / 2].lambda_nm, {}};
    for (std::size_t k = first; k < last; ++k) {
      for (std::size_t c = 0; c < 3; ++c) one.gain[c] += passes[k].gain[c];
    }
    few.push_back(one);
  }
  return few;
}

double area(const Rectangle& r) { return (r.high.x - r.low.x) * (r.high.y - r.low.y); }

}  // namespace

GhostPainter::GhostPainter(const LensState& lens, const IrisShape& iris, const Frame& frame, const LightFrame& light,
                           const TablesByWavelength& tables, int deepest, const GhostScreens* screens,
                           const screens::DirtField* dirt)
    : lens_(lens), iris_(iris), frame_(frame), light_(light), tables_(tables),
      plane_z_mm_(entrance_window(lens, light.source).z_mm), deepest_(deepest), screens_(screens), dirt_(dirt) {}

// How far a fit may be off, from what that does to pixels: edges displaced by d over a length of about 4 L, and
// levels off by a share w over L^2 pixels.
GhostPainter::Tolerance GhostPainter::tolerance_for(const std::vector<RaySheet>& sheets,
                                                    const ErrorBudget& budget) const {
  if (!std::isfinite(budget.squared_error)) return {kNoLimit, kNoLimit, kNoLimit};
  const RaySheet& middle = sheets[sheets.size() / 2];
  Vec2 low{kNoLimit, kNoLimit};
  Vec2 high{-kNoLimit, -kNoLimit};
  double weight = 0.0;
  for (std::size_t k = 0; k < middle.count(); ++k) {
    if (std::isinf(middle.r_rel[k])) continue;
    const Vec2 p = Vec2{middle.sensor_x_mm[k], middle.sensor_y_mm[k]} * (1.0 / frame_.pixel_pitch_mm);
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
    for (std::size_t c = 0; c < 3; ++c) {
      double sum = 0.0;
      for (const RaySheet& sheet : sheets) sum += sheet.weight[c][k];
      weight = std::max(weight, std::abs(sum));
    }
  }
  if (!(weight > 0.0)) return {kNoLimit, kNoLimit, kNoLimit};
  const Vec2 size{std::max(high.x - low.x, 1.0), std::max(high.y - low.y, 1.0)};
  const double side = std::sqrt(size.x * size.y);
  const Vec2 pupil = middle.box.high - middle.box.low;
  const double level = weight * pupil.x * pupil.y * light_.source.shared_flux() / (size.x * size.y);
  const double error =
      kFitShare * std::sqrt(budget.squared_error) / std::min(level, kPeaks * budget.peak);  // in levels, summed
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

void GhostPainter::count(const SheetTracer& tracer) {
  rays_ += tracer.rays();
  surface_hits_ += tracer.surface_hits();
}

std::vector<RaySheet> GhostPainter::first_sheets(Ghost ghost, const Rectangle& box,
                                                 std::span<const PlannedPass> passes) {
  std::vector<RaySheet> sheets;
  for (std::size_t k = 0; k < passes.size(); ++k) {
    SheetTracer tracer(lens_, ghost, light_, plane_z_mm_, {passes[k].lambda_nm, passes.subspan(k, 1)}, tables_,
                       stop_times());
    sheets.push_back(tracer.trace(box, kNodes.front(), PacketPrecision::Double));
    count(tracer);
  }
  return sheets;
}

// The screens of a band's wavelengths, at most three, each with the light of those nearest.
std::shared_ptr<const BandScreen> GhostPainter::band_screen(const std::vector<RaySheet>& sheets, std::size_t first,
                                                            std::size_t last) const {
  const std::size_t passes = last - first, count = std::min<std::size_t>(passes, 3);
  auto band = std::make_shared<BandScreen>();
  std::array<double, 3> sum{}, size{};
  std::vector<std::array<double, 3>> light(count);
  for (std::size_t part = 0; part < count; ++part) {
    const std::size_t from = first + part * passes / count, to = first + (part + 1) * passes / count;
    band->parts.push_back({screens_->by_pass[(from + to) / 2], {}});
    for (std::size_t k = from; k < to; ++k)
      for (std::size_t c = 0; c < 3; ++c)
        for (const float w : sheets[k].weight[c]) light[part][c] += std::isfinite(w) ? w : 0.0F;
    for (std::size_t c = 0; c < 3; ++c) sum[c] += light[part][c], size[c] += std::abs(light[part][c]);
  }
  for (std::size_t part = 0; part < count; ++part)
    for (std::size_t c = 0; c < 3; ++c)
      band->parts[part].channel[c] = static_cast<float>(
          std::abs(sum[c]) > kLightLeft * size[c] ? light[part][c] / sum[c] : 1.0 / static_cast<double>(count));
  bool all_edges = true;
  std::vector<const screens::PatternTexture*> textures;
  for (const auto& part : band->parts) {
    const auto* const edge = dynamic_cast<const screens::EdgeScreen*>(part.screen.get());
    const auto* const pattern = dynamic_cast<const screens::TextureScreen*>(part.screen.get());
    if (pattern != nullptr) textures.push_back(&pattern->texture());
    all_edges = all_edges && edge != nullptr;
    if (edge == nullptr) continue;
    band->unit = std::min(band->unit, edge->unit());
    band->dark_beyond = std::max(band->dark_beyond, -screens_->range.dark * edge->unit());
    band->level_within = std::max(band->level_within, screens_->range.level * edge->unit());
  }
  if (all_edges) band->edges = static_cast<const screens::EdgeScreen*>(band->parts.front().screen.get());
  band->reach = screens_->reach;
  if (textures.size() == band->parts.size()) band->pattern = screens_->patterns->contents().band(textures);
  return band;
}

// How far a ghost moves from one wavelength to another, by the rays that are not far from getting through.
double GhostPainter::shift_px(const RaySheet& a, const RaySheet& b) const {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.count(); ++k) {
    if (!(a.r_rel[k] < kNearlyThrough && b.r_rel[k] < kNearlyThrough)) continue;
    const Vec2 shift{a.sensor_x_mm[k] - b.sensor_x_mm[k], a.sensor_y_mm[k] - b.sensor_y_mm[k]};
    largest = std::max(largest, length(shift));
  }
  return largest / frame_.pixel_pitch_mm;
}

void GhostPainter::paint(Ghost ghost, const Rectangle& box, std::span<const PlannedPass> passes,
                         const ErrorBudget& budget, PolygonList& out) {
  const std::vector<RaySheet> sheets = first_sheets(ghost, box, passes);
  const Tolerance tolerance = tolerance_for(sheets, budget);
  // Wavelengths whose images lie closer than is seen share one geometry.
  const double shift = passes.size() > 1 ? shift_px(sheets.front(), sheets.back()) : 0.0;
  const double wanted = std::ceil(shift / (2.0 * kShiftShare * tolerance.position_px));
  const std::size_t bands = static_cast<std::size_t>(std::clamp(wanted, 1.0, static_cast<double>(passes.size())));
  CellPainter cells(iris_, frame_, budget.squared_error, kFewCells * static_cast<double>(bands), budget.peak, out);
  cells.stand_behind(SeenDirt{dirt_, &light_, plane_z_mm_});
  for (std::size_t band = 0; band < bands; ++band) {
    const std::size_t first = band * passes.size() / bands;
    const std::size_t last = (band + 1) * passes.size() / bands;
    const std::size_t middle = (first + last) / 2;
    if (screens_ != nullptr) cells.stand_behind(band_screen(sheets, first, last), stop_times());
    RaySheet sheet = sheets[middle];
    for (std::size_t k = first; k < last; ++k) {
      for (std::size_t c = 0; c < 3 && k != middle; ++c) {
        for (std::size_t node = 0; node < sheet.count(); ++node) sheet.weight[c][node] += sheets[k].weight[c][node];
      }
    }
    if (sheet.failed == 0) {
      const Patch patch = make_patch(sheet, light_, frame_);
      if (accepts(patch, tolerance)) {
        cells.paint(patch);
        continue;
      }
    }
    const auto few = thinned(passes.subspan(first, last - first));
    SheetTracer tracer(lens_, ghost, light_, plane_z_mm_, {few[few.size() / 2].lambda_nm, few}, tables_, stop_times());
    paint_box(tracer, box, 0, tolerance, cells);
    count(tracer);
  }
}

void GhostPainter::paint_box(SheetTracer& tracer, const Rectangle& box, int depth, const Tolerance& tolerance,
                             CellPainter& cells) {
  for (std::size_t k = depth == 0 ? 1 : 0; k < kNodes.size(); ++k) {
    const PacketPrecision precision = precision_for(box, tolerance);
    RaySheet sheet = tracer.trace(box, kNodes[k], precision);
    const auto part = lit_part(sheet);
    if (!part) return;
    if (depth < deepest_ && area(*part) < kWorthShrinking * area(box)) {
      return paint_box(tracer, *part, depth + 1, tolerance, cells);
    }
    const bool last = k + 1 == kNodes.size();
    if (sheet.failed > 0 && depth < deepest_) break;
    tracer.add_wavelengths(sheet, precision);
    if (sheet.failed == 0) {
      const Patch patch = make_patch(sheet, light_, frame_);
      if (accepts(patch, tolerance) || (last && depth >= deepest_)) return cells.paint(patch);
    } else {
      for (const Patch& patch : patches_of_cells(sheet, light_, frame_)) cells.paint(patch);
      return;
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

}  // namespace contrejour::adaptive
