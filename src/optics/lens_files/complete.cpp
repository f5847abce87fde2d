// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/complete.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "contrejour/expert/first_order.h"
#include "optics/lens/rims.h"

namespace contrejour::inline internal {
namespace {

// Neighbours may cross at their rims by the width of a drawing's line, as two radii for one contact surface do.
constexpr double kSlightCrossing_mm = 0.02;

constexpr double kPlausibleFNumber = 1.0;  // used until the real one is known
constexpr int kHalvings = 50;

// Missing rims get a small size, for computations that do not depend on rims.

std::size_t stop_of(const Prescription& lens) {
  const auto is_stop = [](const Surface& s) { return s.kind == SurfaceKind::Stop; };
  return static_cast<std::size_t>(std::find_if(lens.surfaces.begin(), lens.surfaces.end(), is_stop) -
                                  lens.surfaces.begin());
}

// Sizes each surface for the sum of the heights of the marginal ray and the chief ray.
Result<void> size_for_beam(Prescription& lens, const Beam& beam, const std::vector<bool>& open) {
  Prescription pinhole = lens;
  if (pinhole.f_number == 0.0) pinhole.f_number = kPlausibleFNumber;
  for (Surface& surface : pinhole.surfaces) {
    surface.semi_diameter_mm = kNoRim_mm;
    surface.aperture = {};
    surface.obscuration = {};
  }
  const auto state = configure_lens(pinhole, without_films());
  if (!state) return tl::unexpected(state.error());
  const double lambda_nm = state->design_wavelength_nm;
  const Abcd to_stop = abcd_between(state->surfaces, 0, state->stop_index, lambda_nm);
  const double slope = std::tan(beam.half_field_rad);
  const double chief_mm = to_stop.a == 0.0 ? 0.0 : -to_stop.b / to_stop.a * slope;  // at the first surface
  for (std::size_t k = 0; k < lens.surfaces.size(); ++k) {
    if (!open[k]) continue;
    const Abcd m = abcd_between(state->surfaces, 0, static_cast<int>(k), lambda_nm);
    const double axial_mm = std::abs(m.a) * 0.5 * beam.pupil_diameter_mm;
    const bool is_stop = lens.surfaces[k].kind == SurfaceKind::Stop;
    lens.surfaces[k].semi_diameter_mm = axial_mm + (is_stop ? 0.0 : std::abs(m.a * chief_mm + m.b * slope));
  }
  return {};
}

// The largest value in [0, high] that fits, by bisection: all values below one that fits must fit.
template <class Fits>
double largest_fitting(double high, const Fits& fits) {
  double low = 0.0;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    (fits(middle) ? low : high) = middle;
  }
  return low;
}

// Surfaces whose rims are being fitted.
class RimFitter {
 public:
  RimFitter(Prescription& lens, const std::vector<bool>& open, double min_fraction)
      : lens_(lens), open_(open), min_fraction_(min_fraction), stated_mm_(lens.surfaces.size()) {
    for (std::size_t k = 0; k < stated_mm_.size(); ++k) stated_mm_[k] = lens.surfaces[k].semi_diameter_mm;
  }

  void fit() {
    for (std::size_t k = 0; k < lens_.surfaces.size(); ++k) fit_surface(k);
    for (const auto& thickness_mm : thicknesses_of(lens_)) {
      for_each_neighbours(lens_.surfaces, thickness_mm, [&](std::size_t front, std::size_t back, double gap_mm) {
        fit_pair(front, back, gap_mm);
        return true;
      });
    }
    warn();
  }

 private:
  void shrink(std::size_t k, double semi_mm) {
    Surface& surface = lens_.surfaces[k];
    if (open_[k] || semi_mm >= min_fraction_ * stated_mm_[k])
      surface.semi_diameter_mm = std::min(surface.semi_diameter_mm, semi_mm);
  }

  void fit_surface(std::size_t k) {
    const Surface& surface = lens_.surfaces[k];
    if (!(surface.semi_diameter_mm > 0.0) || reaches(surface, surface.semi_diameter_mm)) return;
    shrink(k, largest_fitting(surface.semi_diameter_mm, [&](double h_mm) { return reaches(surface, h_mm); }));
  }

  void fit_pair(std::size_t front, std::size_t back, double gap_mm) {
    const Surface &before = lens_.surfaces[front], &behind = lens_.surfaces[back];
    const double rim_mm = std::min(before.semi_diameter_mm, behind.semi_diameter_mm);
    if (!(rim_mm > 0.0) || !(gap_mm >= 0.0) || !reaches(before, rim_mm) || !reaches(behind, rim_mm)) return;
    if (smallest_gap(before, behind, gap_mm, rim_mm).gap_mm >= -kTouch_mm) return;
    const auto fits = [&](double h_mm) { return smallest_gap(before, behind, gap_mm, h_mm).gap_mm >= 0.0; };
    const bool either_open = open_[front] || open_[back];
    if (!either_open && !fits(min_fraction_ * rim_mm)) {  // shrink() would refuse; hostile files have many such
      part_slightly(front, back, smallest_gap(before, behind, gap_mm, rim_mm).gap_mm);
      return;
    }
    const double fits_mm = largest_fitting(rim_mm, fits);
    for (const std::size_t k : {front, back})
      if (lens_.surfaces[k].semi_diameter_mm <= rim_mm) shrink(k, fits_mm);
  }

  // Widens the gap by what is missing; a gap that zooming sets stays unchanged.
  void part_slightly(std::size_t front, std::size_t back, double smallest_mm) {
    if (!lens_.zoom.empty() || smallest_mm < -kSlightCrossing_mm) return;
    lens_.surfaces[back - 1].thickness_mm -= smallest_mm;
    lens_.warnings.push_back(fmt::format(
        "surfaces {} and {} (lines {} and {}) cross by {:.2g} mm within their rims; their gap is made so "
        "much wider",
        front + 1, back + 1, lens_.surfaces[front].source_line, lens_.surfaces[back].source_line, -smallest_mm));
  }

  void warn() {
    for (std::size_t k = 0; k < stated_mm_.size(); ++k) {
      const Surface& surface = lens_.surfaces[k];
      if (open_[k] || surface.semi_diameter_mm == stated_mm_[k]) continue;
      lens_.warnings.push_back(fmt::format(
          "surface {} (line {}): drawn to a semi-diameter of {:.6g} mm, where it would end or cross its neighbour; "
          "{:.6g} mm is used",
          k + 1, surface.source_line, stated_mm_[k], surface.semi_diameter_mm));
    }
  }

  Prescription& lens_;
  const std::vector<bool>& open_;
  double min_fraction_;
  std::vector<double> stated_mm_;
};

Result<double> widest_f_number(Prescription lens) {
  constexpr double kWiderThanAny = 0.5;
  lens.f_number = kWiderThanAny;
  const auto state = configure_lens(lens, without_films());
  if (!state) return tl::unexpected(state.error());
  return state->f_number;
}

// Height of the real marginal ray at the stop, which first-order optics only approximates. A lens that forms no image
// has no such ray: the stop's own size is used.
Result<double> stop_opening_mm(Prescription lens) {
  constexpr double kWide_mm = 1e4;
  const double own_mm = lens.surfaces[stop_of(lens)].semi_diameter_mm;
  lens.surfaces[stop_of(lens)].semi_diameter_mm = kWide_mm;
  const auto state = configure_lens(lens, without_films());
  if (!state) return tl::unexpected(state.error());
  return state->stop_radius_mm < kWide_mm ? state->stop_radius_mm : own_mm;
}

}  // namespace

Result<Prescription> completed(Prescription lens, const std::optional<Beam>& beam, double min_fraction) {
  std::vector<bool> open;
  for (const Surface& surface : lens.surfaces) open.push_back(surface.semi_diameter_mm == 0.0);
  const std::size_t stop = stop_of(lens);
  const bool any_open = std::find(open.begin(), open.end(), true) != open.end();
  if (any_open && beam && stop < lens.surfaces.size()) {
    if (const auto sized = size_for_beam(lens, *beam, open); !sized) return tl::unexpected(sized.error());
  }
  RimFitter(lens, open, min_fraction).fit();
  if (lens.f_number == 0.0) {
    lens.f_number = kPlausibleFNumber;
    const auto widest = widest_f_number(lens);
    if (!widest) return tl::unexpected(widest.error());
    lens.f_number = *widest;
  } else if (stop < lens.surfaces.size() && open[stop]) {
    const auto opening_mm = stop_opening_mm(lens);
    if (!opening_mm) return tl::unexpected(opening_mm.error());
    lens.surfaces[stop].semi_diameter_mm = *opening_mm;
  }
  if (const auto valid = validate(lens); !valid) return tl::unexpected(valid.error());
  return lens;
}

}  // namespace contrejour::inline internal
