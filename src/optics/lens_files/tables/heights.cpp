// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/tables/heights.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "optics/lens/rims.h"

namespace contrejour::inline internal {
namespace {

constexpr double kFocalTolerance = 0.2;
constexpr double kSemiFrom = 0.7, kDiameterFrom = 1.7, kDiameterTo = 3.0;  // stop height over marginal ray height

// Height of the real marginal ray at the stop for that f-number.
std::optional<double> needed_at_stop_mm(Prescription lens, double f_number) {
  constexpr double kWide_mm = 1e4;
  for (Surface& s : lens.surfaces) s.semi_diameter_mm = s.kind == SurfaceKind::Stop ? kWide_mm : kNoRim_mm;
  lens.f_number = f_number;
  const auto state = configure_lens(lens, without_films());
  if (!state || !(state->stop_radius_mm > 0.0)) return std::nullopt;
  const auto& stated_mm = lens.stated.focal_length_mm;
  if (stated_mm && !(std::abs(state->focal_length_mm / *stated_mm - 1.0) <= kFocalTolerance)) return std::nullopt;
  return state->stop_radius_mm;
}

std::optional<HeightMeaning> meaning_of_stop(const Prescription& lens, double f_number) {
  for (const Surface& surface : lens.surfaces) {
    if (surface.kind != SurfaceKind::Stop || !(surface.semi_diameter_mm > 0.0)) continue;
    const auto needed_mm = needed_at_stop_mm(lens, f_number);
    if (!needed_mm) return std::nullopt;
    const double ratio = surface.semi_diameter_mm / *needed_mm;
    if (!(ratio >= kSemiFrom && ratio < kDiameterTo)) return std::nullopt;
    return ratio < kDiameterFrom ? HeightMeaning::SemiDiameter : HeightMeaning::Diameter;
  }
  return std::nullopt;
}

// True if surfaces exist up to this fraction of their heights and do not cross within it.
bool fits(const Prescription& lens, double fraction) {
  for (const Surface& surface : lens.surfaces)
    if (!reaches(surface, fraction * surface.semi_diameter_mm)) return false;
  bool fit = true;
  for_each_neighbours(lens.surfaces, thicknesses_of(lens).front(),
                      [&](std::size_t front, std::size_t back, double gap_mm) {
                        const Surface &before = lens.surfaces[front], &behind = lens.surfaces[back];
                        const double rim_mm = fraction * std::min(before.semi_diameter_mm, behind.semi_diameter_mm);
                        // A gap that is negative on the axis is an error, but not one of the rims.
                        fit = !(gap_mm >= 0.0) || smallest_gap(before, behind, gap_mm, rim_mm).gap_mm >= -kTouch_mm;
                        return fit;
                      });
  return fit;
}

}  // namespace

HeightMeaning meaning_of_heights(const Prescription& lens, std::optional<double> f_number, HeightMeaning stated) {
  if (f_number) {
    if (const auto meaning = meaning_of_stop(lens, *f_number)) return *meaning;
  }
  if (stated == HeightMeaning::SemiDiameter && fits(lens, kMinRimFraction)) return stated;
  return fits(lens, 0.5 * kMinRimFraction) ? HeightMeaning::Diameter : HeightMeaning::Unusable;
}

void apply_heights(Prescription& lens, HeightMeaning meaning) {
  const double factor = meaning == HeightMeaning::SemiDiameter ? 1.0 : meaning == HeightMeaning::Diameter ? 0.5 : 0.0;
  for (Surface& surface : lens.surfaces) surface.semi_diameter_mm *= factor;
}

std::optional<Beam> full_frame_beam(const Prescription& lens) {
  constexpr double kHalfDiagonal_mm = 21.633;
  const auto& focal_mm = lens.stated.focal_length_mm;
  if (!focal_mm || !(lens.f_number > 0.0)) return std::nullopt;
  return Beam{*focal_mm / lens.f_number, std::atan(kHalfDiagonal_mm / *focal_mm)};
}

void keep_sensor_without_image(Prescription& lens) {
  const auto& stated_mm = lens.stated.back_focal_distance_mm;
  Prescription centred = lens;
  for (Surface& surface : centred.surfaces) surface.semi_diameter_mm = kNoRim_mm;
  centred.f_number = kAnyFNumber;
  if (!stated_mm || !(*stated_mm > 0.0) || configure_lens(centred, without_films())) return;
  centred.sensor_distance_mm = stated_mm;
  const auto state = configure_lens(centred, without_films());
  if (!state) return;  // the lens has another error
  lens.sensor_distance_mm = stated_mm;
  lens.warnings.push_back(fmt::format(
      "its surfaces form no image behind the lens (computed focal length {:.4g} mm), so some number is wrong; "
      "the sensor stands {:g} mm behind it, as the file says",
      state->focal_length_mm, *stated_mm));
}

void place_openings(Prescription& lens) {
  for (std::size_t k = 1; k < lens.surfaces.size(); ++k) {
    Surface& opening = lens.surfaces[k];
    const bool plain = opening.kind == SurfaceKind::Refracting && opening.curvature_per_mm == 0.0 &&
                       opening.shape.is_sphere() && opening.glass_after == lens.surfaces[k - 1].glass_after;
    if (!plain || opening.thickness_mm >= 0.0) continue;
    lens.surfaces[k - 1].thickness_mm += opening.thickness_mm;
    opening.thickness_mm = 0.0;
  }
}

}  // namespace contrejour::inline internal
