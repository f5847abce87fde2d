// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/emit/pattern_emitter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/adaptive/budget/pattern_budget.h"
#include "render/adaptive/clip/bound_view.h"
#include "render/adaptive/emit/edge_table.h"
#include "render/adaptive/emit/pixel_pattern.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kWidthsPerOctave = 2.0;  // widths of pixels for which edges' tables are made

}  // namespace

// The table of fringes for pixels of about this width.
std::uint32_t PatternEmitter::table_for(double width) {
  const int octave = static_cast<int>(std::lround(kWidthsPerOctave * std::log2(std::max(width, 1e-9))));
  const auto [at, is_new] = tables_.try_emplace(std::pair(band_.pattern.get(), octave), 0);
  if (is_new) at->second = add_edge_table(*band_.pattern, std::exp2(octave / kWidthsPerOctave), out_);
  return at->second;
}

// The index of the weights of the pattern's wavelengths.
std::uint32_t PatternEmitter::weights() {
  const auto [at, is_new] = weights_.try_emplace(band_.pattern.get(), static_cast<std::uint32_t>(out_.weights.size()));
  if (is_new) {
    WavelengthWeights& weights = out_.weights.emplace_back();
    for (std::size_t k = 0; k < band_.pattern->parts.size(); ++k)
      std::ranges::copy(band_.pattern->parts[k].channel, weights[k].begin());
  }
  return at->second;
}

// A texture of the atlas where the light crosses the stop once, and otherwise a table of pixels.
Pattern PatternEmitter::pattern_of(std::span<const Point> polygon, const StopMap& map, int samples) {
  const stop_patterns::BandTexture* const texture = band_.pattern->texture.get();
  if (texture != nullptr && map.crossings() == 1 && (!texture->of_one() || band_.pattern->is_monochrome())) {
    const PatternMap last = map.last(samples);
    return {.kind = PatternKind::Texture,
            .table = texture->index(),
            .level = texture->level_for(last.width),
            .weights = texture->of_one() ? 0 : weights(),
            .samples = static_cast<std::uint32_t>(samples),
            .map = last};
  }
  return pixel_pattern(
      polygon, band_.width, band_.height, samples,
      [&, narrow = map.narrowed(samples)](Vec2 pixel) {
        std::array<StopPoint, kMaxStopCrossings> buffer;
        return band_.pattern->transmittance(narrow.stop_points(pixel, buffer));
      },
      out_);
}

// All pixels of a polygon look up the pattern. A large polygon is first clipped to the bounding polygon of a pattern's
// visible light; behind edges' fringes it is cut into strips.
void PatternEmitter::emit(std::span<const Corner> polygon, double area_px, const LinearIrradiance& irradiance,
                          const StopMap& map, double transmitted) {
  const int samples = samples_across_pixel(band_, irradiance, transmitted, map);
  const bool large = area_px >= kWorthCutting_px;
  const double margin = map.nonlinearity();  // cuts are straight lines, the map is not linear
  remaining_.assign(polygon, map);
  if (band_.pattern->edges == nullptr || map.crossings() > 1) {
    for (std::size_t k = 0; large && band_.pattern->texture && k < stop_patterns::BoundingPolygon::kLines; ++k)
      remaining_.keep_within(
          {stop_patterns::BoundingPolygon::normals()[k], band_.pattern->bounding_polygon.distance(k) + margin}, map);
    if (remaining_.is_empty()) return;
    const std::span<const Point> points = points_.points_of(remaining_.corners());
    return out_.add(points, irradiance, pattern_of(points, map, samples));
  }
  const std::uint32_t table = table_for(map.width() / samples);
  if (!large || out_.edge_tables[table].of_outline)
    return add_fringed(remaining_.corners(), irradiance, map, samples, table);
  emit_in_strips(irradiance, map, samples, table);
}

// Straight lines cut off a part along each edge that has fringes there; the remainder is uniform.
void PatternEmitter::emit_in_strips(const LinearIrradiance& irradiance, const StopMap& map, int samples,
                                    std::uint32_t at) {
  const EdgeTable& table = out_.edge_tables[at];
  const double margin = map.nonlinearity();  // cuts are straight lines, the map is not linear
  for (const IrisBound& bound : out_.bounds) {
    if (remaining_.is_empty()) return;
    const BoundView view(bound, remaining_.corners());
    remaining_.keep_within({view.normal(), view.outer() + table.dark_beyond + margin}, map);
  }
  const auto draw_beyond = [&](const HalfPlane& kept) {
    strip_.take(remaining_);
    strip_.keep_within({kept.normal * -1.0, -kept.distance}, map);
    if (strip_.is_empty()) return;
    remaining_.keep_within(kept, map);
    add_fringed(strip_.corners(), irradiance, map, samples, at);
  };
  for (const IrisBound& bound : out_.bounds) {
    if (remaining_.is_empty()) return;
    const BoundView view(bound, remaining_.corners());
    const Strip level = view.deeper_than(table.level_within + margin);
    if (level.is_empty()) return add_fringed(remaining_.corners(), irradiance, map, samples, at);
    draw_beyond({view.normal(), level.distance});
    if (std::isfinite(level.near_distance)) draw_beyond({view.normal() * -1.0, -level.near_distance});
  }
  if (!remaining_.is_empty()) out_.add(points_.points_of(remaining_.corners()), irradiance);
}

void PatternEmitter::add_fringed(std::span<const PlacedCorner> polygon, const LinearIrradiance& irradiance,
                                 const StopMap& map, int samples, std::uint32_t at) {
  const EdgeTable& table = out_.edge_tables[at];
  const auto first = static_cast<std::uint32_t>(out_.active.size());
  for (std::size_t k = 0; k < out_.bounds.size() && !table.of_outline; ++k) {
    double nearest = -std::numeric_limits<double>::infinity();
    for (const PlacedCorner& c : polygon) nearest = std::max(nearest, out_.bounds[k].distance(c.stop));
    // Distances are convex: inside the polygon none exceeds those at the corners, except where pixels reach beyond it.
    if (nearest + 2.0 * map.pixel_extent() + map.nonlinearity() > -table.level_within)
      out_.active.push_back(static_cast<std::uint16_t>(k));
  }
  out_.add(points_.points_of(polygon), irradiance,
           {.kind = PatternKind::EdgeFringes,
            .table = at,
            .first = first,
            .count = static_cast<std::uint32_t>(out_.active.size()) - first,
            .samples = static_cast<std::uint32_t>(samples),
            .map = map.last(samples)});
}

}  // namespace contrejour::inline internal::adaptive
