// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/emit/pattern_emitter.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "render/adaptive/budget/pattern_budget.h"
#include "render/adaptive/clip/bound_view.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kWidthsPerOctave = 2.0;  // widths of pixels for which edges' tables are made

}  // namespace

// The table of fringes for pixels of about this width.
const EdgeTable& PatternEmitter::table_for(double width) {
  const int octave = static_cast<int>(std::lround(kWidthsPerOctave * std::log2(std::max(width, 1e-9))));
  const auto [at, is_new] = tables_.try_emplace(std::pair(band_.pattern.get(), octave), nullptr);
  if (is_new) {
    out_.tables.push_back(std::make_shared<const EdgeTable>(*band_.pattern, std::exp2(octave / kWidthsPerOctave)));
    at->second = out_.tables.back().get();
  }
  return *at->second;
}

// All pixels of a polygon look up the pattern. A large polygon is first clipped to the bounding polygon of a pattern's
// visible light; behind edges' fringes it is cut into strips.
void PatternEmitter::emit(std::span<const Corner> polygon, double area_px, const Shade& shade, const StopMap& map,
                          double passed) {
  const int looks = looks_across_pixel(band_, shade, passed, map);
  const bool large = area_px >= kWorthCutting_px;
  const double room = map.bend();  // cuts are straight lines, the map is not linear
  rest_.place(polygon, map);
  if (band_.pattern->edges == nullptr || map.crossings() > 1) {
    for (std::size_t k = 0; large && band_.pattern->texture && k < stop_patterns::PatternHull::kLines; ++k)
      rest_.keep_within({stop_patterns::PatternHull::normals()[k], band_.pattern->hull.most(k) + room}, map);
    if (!rest_.is_empty())
      out_.add(points_.points_of(rest_.corners()), shade,
               Screened{.map = map.narrowed(looks), .pattern = band_.pattern.get(), .looks = looks}, {});
    return;
  }
  const EdgeTable& table = table_for(map.width() / looks);
  if (!large || table.iris().is_picture()) return add_fringed(rest_.corners(), shade, map, looks, table);
  emit_in_strips(shade, map, looks, table);
}

// Straight lines cut off a part along each edge that has fringes there; the remainder is uniform.
void PatternEmitter::emit_in_strips(const Shade& shade, const StopMap& map, int looks, const EdgeTable& table) {
  const double room = map.bend();  // cuts are straight lines, the map is not linear
  for (const IrisBound& bound : table.iris().bounds()) {
    if (rest_.is_empty()) return;
    const BoundView view(bound, rest_.corners());
    rest_.keep_within({view.normal(), view.outer() + table.dark_beyond() + room}, map);
  }
  const auto draw_beyond = [&](const HalfPlane& kept) {
    strip_.take(rest_);
    strip_.keep_within({kept.normal * -1.0, -kept.most}, map);
    if (strip_.is_empty()) return;
    rest_.keep_within(kept, map);
    add_fringed(strip_.corners(), shade, map, looks, table);
  };
  for (const IrisBound& bound : table.iris().bounds()) {
    if (rest_.is_empty()) return;
    const BoundView view(bound, rest_.corners());
    const Strip level = view.deeper_than(table.level_within() + room);
    if (level.is_empty()) return add_fringed(rest_.corners(), shade, map, looks, table);
    draw_beyond({view.normal(), level.most});
    if (std::isfinite(level.least)) draw_beyond({view.normal() * -1.0, -level.least});
  }
  if (!rest_.is_empty()) out_.add(points_.points_of(rest_.corners()), shade);
}

void PatternEmitter::add_fringed(std::span<const PlacedCorner> polygon, const Shade& shade, const StopMap& map,
                                 int looks, const EdgeTable& table) {
  active_.clear();
  const auto& bounds = table.iris().bounds();
  for (std::size_t k = 0; k < bounds.size() && !table.iris().is_picture(); ++k) {
    double nearest = -std::numeric_limits<double>::infinity();
    for (const PlacedCorner& c : polygon) nearest = std::max(nearest, bounds[k].distance(c.stop));
    // Distances are convex: inside the polygon none exceeds those at the corners, except where pixels reach beyond it.
    if (nearest + 2.0 * map.pixel_reach() + map.bend() > -table.level_within())
      active_.push_back(static_cast<std::uint16_t>(k));
  }
  out_.add(points_.points_of(polygon), shade,
           Screened{.map = map.narrowed(looks), .pattern = band_.pattern.get(), .edges = &table, .looks = looks},
           active_);
}

}  // namespace contrejour::inline internal::adaptive
