// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/lost_gap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>

#include "contrejour/expert/first_order.h"
#include "optics/lens_files/complete.h"

namespace contrejour::inline internal {
namespace {

constexpr double kSameFocus = 0.0015;  // of the focal length: tolerance for rounded figures
constexpr double kPlainly = 2.0;        // factor by which the stated focus is met better than with any other gap
constexpr double kWidest = 2.0;  // of the focal length: no gap is wider

// How much wider the gap behind a surface must be to give the focal length; none if no width does. With the widening t
// the matrix is rear * (1 t, 0 1) * front, linear in t; its element c is -1 / f.
struct Widened {
  double by_mm = 0, back_focal_mm = 0;
};
std::optional<Widened> widened(const LensState& lens, int behind, double focal_mm) {
  const int last = static_cast<int>(lens.surfaces.size()) - 1;
  const double lambda_nm = lens.design_wavelength_nm;
  const Abcd front = abcd_between(lens.surfaces, 0, behind, lambda_nm);
  const Abcd all = abcd_between(lens.surfaces, 0, last, lambda_nm);
  // The part behind the gap: from the vertex of the next surface on.
  const Abcd rear = abcd_between(lens.surfaces, behind + 1, last, lambda_nm);
  const double per_mm = rear.c * front.c;
  if (per_mm == 0.0) return std::nullopt;
  const double by_mm = (-1.0 / focal_mm - all.c) / per_mm;
  return Widened{by_mm, focal_mm * (all.a + by_mm * rear.a * front.c)};
}

}  // namespace

void warn_of_lost_gap(Prescription& lens) {
  const auto &focal_mm = lens.stated.focal_length_mm, &back_mm = lens.stated.back_focal_distance_mm;
  if (!focal_mm || !back_mm || !lens.zoom.empty()) return;
  const auto state = configure_lens(lens, without_films());
  if (!state || std::abs(state->focal_length_mm / *focal_mm - 1.0) <= lens.stated.tolerance) return;
  const double own_back_mm = first_order(*state, state->design_wavelength_nm).back_focal_distance_mm;
  if (std::abs(own_back_mm - *back_mm) <= kSameFocus * *focal_mm) return;  // a lost gap would also move the focus
  std::size_t best = 0;
  double wide_mm = 0.0, smallest = std::numeric_limits<double>::infinity(), second = smallest;
  for (std::size_t k = 0; k + 1 < lens.surfaces.size(); ++k) {
    if (!is_air(lens.surfaces[k].glass_after) || lens.surfaces[k + 1].kind == SurfaceKind::Stop) continue;
    const auto gap = widened(*state, static_cast<int>(k), *focal_mm);
    if (!gap || !(gap->by_mm > 0.0 && gap->by_mm <= kWidest * *focal_mm)) continue;
    const double off = std::abs(gap->back_focal_mm - *back_mm) / *focal_mm;
    second = std::min(second, std::max(off, smallest));
    if (off >= smallest) continue;
    smallest = off;
    best = k;
    wide_mm = lens.surfaces[k].thickness_mm + gap->by_mm;
  }
  if (smallest > kSameFocus || second < kPlainly * smallest) return;
  lens.warnings.push_back(
      fmt::format("a gap of {:.4g} mm behind surface {} (line {}), where the file has {:g} mm, gives the "
                  "stated focal length and back focal distance both: was an opening left out with "
                  "the gap behind it?",
                  wide_mm, best + 1, lens.surfaces[best].source_line, lens.surfaces[best].thickness_mm));
}

}  // namespace contrejour::inline internal
