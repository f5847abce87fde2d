// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/emit/polygon_emitter.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "render/adaptive/budget/small_polygons.h"
#include "render/adaptive/cells/cell_shape.h"
#include "render/adaptive/emit/line_parts.h"
#include "render/adaptive/emit/pixel_pattern.h"

namespace contrejour::inline internal::adaptive {
namespace {

// The irradiance of a small polygon from its flux: the cell's flux times `fraction_per_px`. Near a focus irradiance
// varies within cells that pixels do not resolve, so that the fraction of flux that the iris transmits is not the
// fraction of area that it leaves.
LinearIrradiance uniform_irradiance(const CellLight& light, double fraction_per_px) {
  LinearIrradiance even{.at = light.irradiance.at};
  for (std::size_t c = 0; c < 3; ++c) even.value[c] = static_cast<float>(light.flux[c] * fraction_per_px);
  return even;
}

// The same for a polygon of a few pixels, which keeps the slope of its irradiance.
LinearIrradiance with_flux(std::span<const Corner> polygon, const CellLight& light, double fraction) {
  constexpr double kMaxCorrection = 2.0;
  const LinearIrradiance& of = light.irradiance;
  const Vec2 from_middle =
      area_of(polygon.size(), [&](std::size_t k) { return polygon[k].uv; }).centroid - Vec2{0.5, 0.5};
  fraction *= std::max(1.0 + dot(light.slope, from_middle), 0.0);
  const auto [area, middle] = area_of(polygon.size(), [&](std::size_t k) { return polygon[k].position; });
  const Vec2 from = middle - Vec2{of.at.x, of.at.y};
  LinearIrradiance out = of;
  for (std::size_t c = 0; c < 3; ++c) {
    const double has = (of.value[c] + of.along_x[c] * from.x + of.along_y[c] * from.y) * std::abs(area);
    const double times = light.flux[c] * fraction / has;
    if (!(times > 1.0 / kMaxCorrection && times < kMaxCorrection)) continue;
    for (Channels LinearIrradiance::* part :
         {&LinearIrradiance::value, &LinearIrradiance::along_x, &LinearIrradiance::along_y})
      (out.*part)[c] *= static_cast<float>(times);
  }
  return out;
}

// These sizes decide how a polygon is emitted.
struct PolygonSize {
  Bounds bounds;
  double twice_area = 0.0, twice_fraction = 0.0;  // signed: of the frame, and of uv

  explicit PolygonSize(std::span<const Corner> polygon) {
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Corner& c = polygon[k];
      bounds.add(c.position);
      if (k < 2) continue;
      twice_area += cross(polygon[k - 1].position - polygon[0].position, c.position - polygon[0].position);
      twice_fraction += cross(polygon[k - 1].uv - polygon[0].uv, c.uv - polygon[0].uv);
    }
  }
  [[nodiscard]] double longest() const { return std::max(bounds.size().x, bounds.size().y); }
  [[nodiscard]] bool is_in_one_pixel() const {
    const Vec2 low = bounds.low, high = bounds.high;
    return std::floor(low.x) == std::floor(high.x) && std::floor(low.y) == std::floor(high.y);
  }
  [[nodiscard]] bool is_resolved() const {
    const bool sliver = std::abs(twice_area) < kSliver * longest();
    return !is_in_one_pixel() && !sliver && longest() > kPoint_px;
  }
};

// The two corners that are farthest from each other.
std::array<Vec2, 2> ends_of(std::span<const Corner> polygon) {
  std::array<Vec2, 2> ends{polygon[0].position, polygon[0].position};
  for (const Corner& a : polygon) {
    for (const Corner& b : polygon) {
      if (length(b.position - a.position) > length(ends[1] - ends[0])) ends = {a.position, b.position};
    }
  }
  return ends;
}

// Whether a polygon is so thin that its corners, in float, do not hold its area, and so straight that it is a line.
bool is_line(std::span<const Corner> polygon, const PolygonSize& size) {
  if (std::abs(size.twice_area) > 2.0 * kThin_px * size.longest()) return false;
  const auto [from, to] = ends_of(polygon);
  const double most = kThin_px * length(to - from);
  return std::ranges::all_of(
      polygon, [&, a = from, b = to](const Corner& c) { return std::abs(cross(b - a, c.position - a)) <= most; });
}

}  // namespace

void PolygonEmitter::emit(std::span<const Corner> polygon, const CellLight& light, const Occluders& occluders) {
  if (polygon.size() < 3) return;
  const PolygonSize size(polygon);
  const double area = 0.5 * std::abs(size.twice_area);
  const double fraction = 0.5 * std::abs(size.twice_fraction) * (light.triangle ? 2.0 : 1.0);
  if (size.is_resolved() && !is_line(polygon, size)) {
    const double longest = size.longest();
    CellLight small = light;
    if (longest < kSmall_px) {
      small.irradiance = uniform_irradiance(light, fraction / area);
    } else if (longest < kFew_px && !light.triangle) {  // half of a cell need not have half of its flux
      small.irradiance = with_flux(polygon, light, fraction);
    }
    return emit_resolved(polygon, area, small, occluders);
  }
  const Flux flux{light.flux[0] * fraction, light.flux[1] * fraction, light.flux[2] * fraction};
  emit_line(polygon, transmitted(flux, (size.bounds.low + size.bounds.high) * 0.5, occluders));
}

// The flux that remains of a polygon at a point.
Flux PolygonEmitter::transmitted(Flux flux, Vec2 pixel, const Occluders& occluders) const {
  if (occluders.pattern != nullptr) {
    std::array<StopPoint, kMaxStopCrossings> buffer;
    const auto transmitted = band_.pattern->transmittance(occluders.pattern->stop_points(pixel, buffer));
    for (std::size_t c = 0; c < 3; ++c) flux[c] *= transmitted[c];
  }
  if (occluders.dirt != nullptr) {
    const auto left = dirt_transmittance(band_, *occluders.dirt).transmitted(pixel);
    for (std::size_t c = 0; c < 3; ++c) flux[c] *= left[c];
  }
  return flux;
}

void PolygonEmitter::emit_resolved(std::span<const Corner> polygon, double area_px, const CellLight& light,
                                   const Occluders& occluders) {
  const bool outlined = occluders.dirt != nullptr && band_.dirt.band->outlines() != nullptr;
  if (occluders.dirt != nullptr && !outlined) return emit_occluded_by_dirt(polygon, light.irradiance, occluders);
  if (occluders.pattern != nullptr) {
    patterns_.emit(polygon, area_px, light.irradiance, *occluders.pattern, occluders.max_transmittance);
  } else {
    out_.add(points_.points_of(polygon), light.irradiance);
  }
  if (outlined) emit_shadows(polygon, light, occluders);
}

// A picture of dirt, and shapes that overlap many times, are looked up pixel by pixel.
void PolygonEmitter::emit_occluded_by_dirt(std::span<const Corner> polygon, const LinearIrradiance& irradiance,
                                           const Occluders& occluders) {
  const DirtTransmittance dirt = dirt_transmittance(band_, *occluders.dirt);
  const auto transmittance_at = [&](Vec2 pixel) {
    std::array<StopPoint, kMaxStopCrossings> buffer;
    std::array<double, 3> all{1.0, 1.0, 1.0};
    if (occluders.pattern != nullptr) all = band_.pattern->transmittance(occluders.pattern->stop_points(pixel, buffer));
    const auto left = dirt.transmitted(pixel);
    for (std::size_t c = 0; c < 3; ++c) all[c] *= left[c];
    return all;
  };
  const std::span<const Point> points = points_.points_of(polygon);
  out_.add(points, irradiance, pixel_pattern(points, band_.width, band_.height, 1, transmittance_at, out_));
}

// Shapes of dirt subtract their light as polygons of negative sign.
void PolygonEmitter::emit_shadows(std::span<const Corner> polygon, const CellLight& light, const Occluders& occluders) {
  const DirtTriangle& dirt = *occluders.dirt;
  std::array<stop_patterns::PlaneView, kMaxStopCrossings> views;
  double finest_mm = 0.0;
  for (std::size_t c = 0; c < dirt.crossings; ++c) {
    views[c] = stop_patterns::PlaneView::through(dirt.pixel, dirt.point_mm[c]);
    finest_mm = c == 0 ? pixel_mm(views[c]) : std::min(finest_mm, pixel_mm(views[c]));
  }
  // The coordinates of the three corners in their cell, in the order in which they are drawn.
  constexpr std::array kInCell{Vec2{0.0, 0.0}, Vec2{1.0, 0.0}, Vec2{1.0, 1.0}};
  const auto in_cell = stop_patterns::PlaneView::through(dirt.pixel, kInCell);
  std::vector<Vec2> outline;
  for (const Corner& c : polygon) outline.push_back(c.position);
  std::vector<Corner> part;
  shadows_.for_each(*band_.dirt.band->outlines(), {views.data(), dirt.crossings}, outline, finest_mm,
                    [&](std::span<const Vec2> shadow, double blocked) {
                      CellLight taken = light;
                      taken.dim({-blocked, -blocked, -blocked});
                      part.assign(shadow.size(), Corner{});
                      double twice_area = 0.0;
                      for (std::size_t k = 0; k < shadow.size(); ++k) {
                        part[k].position = shadow[k];
                        part[k].uv = in_cell.at(shadow[k]);
                        if (k > 1) twice_area += cross(shadow[k - 1] - shadow[0], shadow[k] - shadow[0]);
                      }
                      emit_resolved(part, 0.5 * std::abs(twice_area), taken,
                                    {occluders.pattern, nullptr, occluders.max_transmittance});
                    });
}

// Emits a polygon thinner than rounding can resolve as points that carry its flux, one in each pixel that it crosses.
void PolygonEmitter::emit_line(std::span<const Corner> polygon, const Flux& flux) {
  const auto [from, to] = ends_of(polygon);
  for_each_pixel_part(from, to, band_.width, band_.height, [&](Vec2 middle, double fraction) {
    LinearIrradiance point;
    for (std::size_t c = 0; c < 3; ++c) point.value[c] = static_cast<float>(flux[c] * fraction);
    point.at = {static_cast<float>(middle.x), static_cast<float>(middle.y)};
    out_.add({&point.at, 1}, point);
  });
}

}  // namespace contrejour::inline internal::adaptive
