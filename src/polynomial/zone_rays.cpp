// SPDX-License-Identifier: Apache-2.0
#include "polynomial/zone_rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "polynomial/chebyshev_basis.h"
#include "render/pupils/ghost_pupil.h"
#include "render/pupils/pupil_search.h"

namespace contrejour::inline internal::polynomial {
namespace {

constexpr double kMargin = 0.12;  // around the light, of the size of its bounds: cells of a map extend beyond its edge
constexpr std::array kSearched_nm{420.0, 550.0, 680.0};

// Searches without axial symmetry: rays along a side of the grids, and how much wider the box of one wavelength is
// searched at another, of its size on each side.
constexpr int kAsymmetricSide = 33;
constexpr double kNearbyMargin = 0.15;

Rectangle enlarged(const Rectangle& box, double by) {
  const Vec2 more = (box.high - box.low) * by;
  return {box.low - more, box.high + more};
}

double cosine_spaced(double t) { return 0.5 * (1.0 - std::cos(std::numbers::pi * t)); }
double cosine_density(double t) { return 0.5 * std::numbers::pi * std::sin(std::numbers::pi * t); }

}  // namespace

double RayTable::clearance(std::size_t ray) const {
  double largest = relative_height[ray];
  for (const auto& crossing : stop)
    largest = std::max(largest, static_cast<double>(std::hypot(crossing[0][ray], crossing[1][ray])));
  return largest;
}

LightSource GhostRays::light_at(Vec2 tangents) { return LightSource(normalized({tangents.x, tangents.y, 1.0})); }

PolynomialBounds GhostRays::bounds(double field) const {
  const LightSource light = light_at({field, 0.0});
  const auto pupil = pupils::find_ghost_pupil({steps_, ghost_, light, entrance_window(lens_, light), kSearched_nm});
  PolynomialBounds found{static_cast<float>(field), 0.0F, 0.0F, 0.0F};
  if (pupil.boxes.empty()) return found;
  Rectangle hull = pupil.boxes.front();
  for (const Rectangle& box : pupil.boxes) hull = both(hull, box);
  const double more_mm = kMargin * 0.5 * (hull.high.x - hull.low.x);
  found.low_x_mm = static_cast<float>(hull.low.x - more_mm);
  found.high_x_mm = static_cast<float>(hull.high.x + more_mm);
  found.half_y_mm = static_cast<float>((1.0 + kMargin) * std::max(hull.high.y, -hull.low.y));
  return found;
}

AsymmetricBounds GhostRays::bounds(Vec2 tangents, const std::optional<Rectangle>& near, bool everywhere) const {
  const LightSource light = light_at(tangents);
  const EntranceWindow window = entrance_window(lens_, light);
  // Points of the window's plane lie elsewhere in the fit's.
  const Vec2 shift = tangents * (entrance_z_mm_ - window.z_mm);
  RayGrid grid;
  std::optional<Rectangle> hull;
  const pupils::PupilEffort effort = everywhere ? pupils::PupilEffort::Finest : pupils::PupilEffort::Finer;
  const auto include = [&](double lambda_nm, const std::optional<Rectangle>& hint) {
    pupils::PupilRays rays(PacketPath(steps_.at(lambda_nm), ghost_, {{0.0, 0.0, window.z_mm}, light}), window);
    pupils::Pupil found;
    if (hint) found = pupils::find_pupil(rays, {.hint = hint}, grid);
    if (found.is_empty()) found = pupils::find_pupil(rays, {.effort = effort, .side = kAsymmetricSide}, grid);
    if (!found.is_empty()) hull = hull ? both(*hull, found.box()) : found.box();
  };
  std::optional<Rectangle> hint;
  if (near) hint = Rectangle{near->low - shift, near->high - shift};
  include(kSearched_nm[1], hint);
  if (!hull) return {};
  for (const double lambda_nm : {kSearched_nm[0], kSearched_nm[2]}) include(lambda_nm, enlarged(*hull, kNearbyMargin));
  const Rectangle bounds = enlarged(*hull, kMargin / 2.0);
  return {static_cast<float>(bounds.low.x + shift.x), static_cast<float>(bounds.low.y + shift.y),
          static_cast<float>(bounds.high.x + shift.x), static_cast<float>(bounds.high.y + shift.y)};
}

RayTable GhostRays::trace(std::span<const RayStart> starts, double lambda_nm) const {
  RayTable table;
  const std::size_t count = starts.size();
  for (auto* values : {&table.sensor_x_mm, &table.sensor_y_mm, &table.transmission, &table.relative_height})
    values->resize(count);
  std::vector<float> x_mm(count), y_mm(count), rims;
  for (std::size_t from = 0, to = 0; from < count; from = to) {
    while (to < count && starts[to].field == starts[from].field && starts[to].field_y == starts[from].field_y) ++to;
    const LightSource light = light_at({starts[from].field, starts[from].field_y});
    PacketPath path(steps_.at(lambda_nm), ghost_, {{0.0, 0.0, entrance_z_mm_}, light});
    const Vec2 origin = starts[from].entrance_mm;
    for (std::size_t k = from; k < to; ++k) {
      x_mm[k] = static_cast<float>(starts[k].entrance_mm.x - origin.x);
      y_mm[k] = static_cast<float>(starts[k].entrance_mm.y - origin.y);
    }
    path.start_from(origin);
    if (table.stop.empty()) {
      table.stop.resize(static_cast<std::size_t>(path.stop_crossings()));
      for (auto& crossing : table.stop)
        for (auto& axis : crossing) axis.resize(count);
      rims.assign(path.steps().size() * count, 0.0F);
    }
    TracedArrays out{table.sensor_x_mm.data() + from,
                     table.sensor_y_mm.data() + from,
                     table.transmission.data() + from,
                     table.relative_height.data() + from,
                     {},
                     {},
                     rims.data() + from,
                     count};
    for (std::size_t c = 0; c < table.stop.size(); ++c) {
      out.stop_x[c] = table.stop[c][0].data() + from;
      out.stop_y[c] = table.stop[c][1].data() + from;
    }
    trace_packets(path, PacketPrecision::Double, x_mm.data() + from, y_mm.data() + from, to - from, out);
  }
  for (std::size_t at = 0; at < rims.size(); at += count)
    table.rim_squared.emplace_back(rims.begin() + static_cast<std::ptrdiff_t>(at),
                                   rims.begin() + static_cast<std::ptrdiff_t>(at + count));
  return table;
}

std::vector<RayStart> starts_within(std::span<const PolynomialBounds> bounds, int count, std::size_t first) {
  // Roberts' R2 sequence: multiples of the powers of the inverse of the plastic number.
  constexpr double kStepX = 0.7548776662466927, kStepY = 0.5698402909980532;
  std::vector<RayStart> starts;
  std::size_t index = first;
  for (const PolynomialBounds& b : bounds) {
    if (!has_light(b)) continue;
    const double width = static_cast<double>(b.high_x_mm) - b.low_x_mm;
    for (int k = 0; k < count; ++k, ++index) {
      const double x = std::fmod(0.5 + kStepX * static_cast<double>(index), 1.0);
      const double y = std::fmod(0.5 + kStepY * static_cast<double>(index), 1.0);
      // y from the middle (0) to the border (1).
      const double to_border = std::sin(0.5 * std::numbers::pi * y);
      const double density = cosine_density(x) * 0.5 * std::numbers::pi * std::cos(0.5 * std::numbers::pi * y);
      starts.push_back({b.field,
                        {b.low_x_mm + width * cosine_spaced(x), b.half_y_mm * to_border},
                        density * width * 2.0 * b.half_y_mm / count});
    }
  }
  return starts;
}

PolynomialBounds bounds_between(const PolynomialZone& zone, double field) {
  const auto at = static_cast<float>(field);
  const auto centre = static_cast<float>(centre_at(zone, field));
  for (std::size_t k = 0; k + 1 < zone.bounds.size(); ++k) {
    const PolynomialBounds &a = zone.bounds[k], &b = zone.bounds[k + 1];
    if (at < a.field || at > b.field || !has_light(a) || !has_light(b)) continue;
    const auto centre_a = static_cast<float>(centre_at(zone, a.field));
    const auto centre_b = static_cast<float>(centre_at(zone, b.field));
    return {at, centre + std::min(a.low_x_mm - centre_a, b.low_x_mm - centre_b),
            centre + std::max(a.high_x_mm - centre_a, b.high_x_mm - centre_b), std::max(a.half_y_mm, b.half_y_mm)};
  }
  return {at, 0.0F, 0.0F, 0.0F};
}

}  // namespace contrejour::inline internal::polynomial
