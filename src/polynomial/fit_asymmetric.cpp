// SPDX-License-Identifier: Apache-2.0
#include "polynomial/fit_asymmetric.h"

#include <algorithm>
#include <cmath>

#include "contrejour/expert/trace.h"
#include "polynomial/fit_lens.h"

namespace contrejour::inline internal::polynomial {
namespace {

using ZoneState = PolynomialZone::State;
using AsymmetricZones = std::vector<AsymmetricZone>;

constexpr int kMostHalvings = 2;  // a zone has four times as many halves as one of the field's radius

// Whether a shape or an aperture that is rotated has the lens's axes as its own.
bool is_along_axes(double rotation_rad) { return std::abs(std::sin(2.0 * rotation_rad)) < 1e-12; }

bool is_mirrored_by_itself(const SurfaceState& surface, double Vec2::* of_aperture, double Vec3::* of_pose) {
  if (surface.pose.shift_mm.*of_pose != 0.0 || surface.pose.axis.*of_pose != 0.0) return false;
  if (!surface.shape.has_axial_symmetry() && !is_along_axes(surface.shape.rotation_rad)) return false;
  const ClearAperture& aperture = surface.aperture;
  return aperture.kind == ApertureKind::Disc ||
         (aperture.centre_mm.*of_aperture == 0.0 && is_along_axes(aperture.rotation_rad));
}

// A zone from low to high without more.
AsymmetricZone place_of(const AsymmetricZone& parent, Vec2 low, Vec2 high) {
  AsymmetricZone zone;
  zone.low = low;
  zone.high = high;
  zone.even_x = parent.even_x && low.x < 0.0;
  zone.even_y = parent.even_y && low.y < 0.0;
  return zone;
}

// Halves of the area along the longer side. One half of an even zone is around its middle, the other one is on the
// positive side and stands for its mirror image, too.
AsymmetricZones halves_of(const AsymmetricZone& zone) {
  const Vec2 size = zone.high - zone.low;
  const bool along_y = size.y > size.x;
  const bool even = along_y ? zone.even_y : zone.even_x;
  double Vec2::* const axis = along_y ? &Vec2::y : &Vec2::x;
  const double cut = even ? 0.5 * zone.high.*axis : 0.5 * (zone.low.*axis + zone.high.*axis);
  Vec2 first_low = zone.low, first_high = zone.high, second_low = zone.low;
  first_high.*axis = cut;
  second_low.*axis = cut;
  if (even) first_low.*axis = -cut;
  return {place_of(zone, first_low, first_high), place_of(zone, second_low, zone.high)};
}

AsymmetricZone without_bounds(AsymmetricZone zone) {
  if (zone.state == ZoneState::Fitted) return zone;
  zone.bounds.clear();
  zone.bounds_side = 0;
  return zone;
}

AsymmetricZones fit_zones(const AsymmetricProblem& problem, const AsymmetricZone& place, int halvings) {
  AsymmetricZone whole = fit_asymmetric_zone(problem, place);
  // Errors that are much larger than accepted mean a branch point next to the light, which smaller zones do not avoid.
  constexpr double kWorthHalving = 8.0;
  const bool hopeless = !(whole.accuracy.position_p95_px <= kWorthHalving * problem.options.position_px);
  if (whole.state != ZoneState::Traced || halvings == 0 || hopeless) return {without_bounds(std::move(whole))};
  AsymmetricZones parts;
  for (const AsymmetricZone& half : halves_of(place))
    std::ranges::move(fit_zones(problem, half, halvings - 1), std::back_inserter(parts));
  const bool none =
      std::ranges::all_of(parts, [](const AsymmetricZone& zone) { return zone.state == ZoneState::Traced; });
  return none ? AsymmetricZones{without_bounds(std::move(whole))} : parts;
}

// The rectangle of directions with light, from one node of the grid before to one behind; the whole zone if that is
// not much smaller.
AsymmetricZone lit_part(const AsymmetricZone& zone) {
  constexpr double kWorthCutting = 0.85;  // of the area
  const int cells = zone.bounds_side - 1;
  int first_x = cells, last_x = 0, first_y = cells, last_y = 0;
  for (int iy = 0; iy <= cells; ++iy)
    for (int ix = 0; ix <= cells; ++ix) {
      if (!lets_light_in(zone.bounds[static_cast<std::size_t>(iy * zone.bounds_side + ix)])) continue;
      first_x = std::min(first_x, std::max(ix - 1, 0)), last_x = std::max(last_x, std::min(ix + 1, cells));
      first_y = std::min(first_y, std::max(iy - 1, 0)), last_y = std::max(last_y, std::min(iy + 1, cells));
    }
  if (first_x >= last_x || first_y >= last_y || (last_x - first_x) * (last_y - first_y) > kWorthCutting * cells * cells)
    return place_of(zone, zone.low, zone.high);
  const auto at = [&](int ix, int iy) { return tangents_at(zone, {2.0 * ix / cells - 1.0, 2.0 * iy / cells - 1.0}); };
  AsymmetricZone part = place_of(zone, at(first_x, first_y), at(last_x, last_y));
  // An even zone's light is on both sides.
  if (part.even_x) part.low.x = -part.high.x;
  if (part.even_y) part.low.y = -part.high.y;
  return part;
}

// The rectangles of a zone around a part of it, as zones without light.
void add_dark(const AsymmetricZone& zone, const AsymmetricZone& part, AsymmetricZones& zones) {
  const auto add = [&](Vec2 low, Vec2 high) {
    if (low.x < high.x && low.y < high.y) zones.push_back(place_of(zone, low, high));
  };
  if (!part.even_x) add(zone.low, {part.low.x, zone.high.y});
  add({part.high.x, zone.low.y}, zone.high);
  if (!part.even_y) add({part.low.x, zone.low.y}, {part.high.x, part.low.y});
  add({part.low.x, part.high.y}, {part.high.x, zone.high.y});
}

}  // namespace

MirrorPlanes mirror_planes(const LensState& lens, const Ghost& ghost) {
  MirrorPlanes planes{true, true};
  for (const PathStep& step : ghost_path(lens, ghost, lens.design_wavelength_nm).steps) {
    if (step.surface >= static_cast<int>(lens.surfaces.size())) continue;  // the sensor
    const SurfaceState& surface = lens.surfaces[static_cast<std::size_t>(step.surface)];
    planes.x = planes.x && is_mirrored_by_itself(surface, &Vec2::x, &Vec3::x);
    planes.y = planes.y && is_mirrored_by_itself(surface, &Vec2::y, &Vec3::y);
  }
  return planes;
}

Vec2 largest_tangents(const LensState& lens, const PolynomialOptions& options) {
  if (options.half_field_rad > 0.0) return {std::tan(options.half_field_rad), std::tan(options.half_field_rad)};
  Vec2 largest;
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      const Vec3 corner = direction_for_image_point(lens, {x * lens.sensor_width_mm, y * lens.sensor_height_mm},
                                                    lens.design_wavelength_nm);
      largest.x = std::max(largest.x, kBeyondCorner * std::abs(corner.x / corner.z));
      largest.y = std::max(largest.y, kBeyondCorner * std::abs(corner.y / corner.z));
    }
  }
  return largest;
}

GhostPolynomials fit_asymmetric_ghost(const AsymmetricProblem& problem, const LensState& lens, const Ghost& ghost,
                                      Vec2 largest) {
  const MirrorPlanes planes = mirror_planes(lens, ghost);
  GhostPolynomials fitted{ghost, {traced_zone(problem.lens)}, {}, planes.x, planes.y};
  AsymmetricZone field;
  field.low = largest * -1.0;
  field.high = largest;
  field.even_x = planes.x;
  field.even_y = planes.y;
  const AsymmetricZone found = with_bounds(problem, field);
  const AsymmetricZone part = lit_part(found);
  const int halvings = std::min(problem.options.max_halvings, kMostHalvings);
  fitted.asymmetric = fit_zones(problem, part, halvings);
  add_dark(field, part, fitted.asymmetric);
  return fitted;
}

}  // namespace contrejour::inline internal::polynomial
