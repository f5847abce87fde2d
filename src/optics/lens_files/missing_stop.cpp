// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/missing_stop.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "contrejour/expert/first_order.h"
#include "optics/lens_files/complete.h"

namespace contrejour::inline internal {
namespace {

constexpr double kMinClearance = 0.02;  // of the lens's length: a narrower gap has no space for an iris
constexpr double kSameFocalLength = 0.2;  // relative: with a larger deviation the rows are not the whole lens
constexpr std::array kFractions{0.05, 0.5, 0.95};  // within a gap
constexpr int kFields = 60;
constexpr double kWidestField_rad = std::numbers::pi / 3.0;

// Heights at every row, just in front of it, and slopes behind it, of a ray parallel to the axis at height 1 and of one
// through the first vertex at slope 1.
struct RowRays {
  double axial = 0, tilted = 0, axial_slope = 0, tilted_slope = 0;
};

std::vector<RowRays> rays_of(const LensState& state) {
  std::vector<RowRays> rays;
  for (int k = 1; k < static_cast<int>(state.surfaces.size()); ++k) {  // 0 is the auxiliary stop
    const Abcd m = abcd_between(state.surfaces, 0, k, state.design_wavelength_nm);
    rays.push_back({m.a, m.b, m.c, m.d});
  }
  return rays;
}

bool has_stop(const Prescription& lens) {
  return std::any_of(lens.surfaces.begin(), lens.surfaces.end(),
                     [](const Surface& s) { return s.kind == SurfaceKind::Stop; });
}

bool is_opening(const Prescription& lens, std::size_t k) {
  const Surface& s = lens.surfaces[k];
  return k > 0 && s.curvature_per_mm == 0.0 && s.shape.is_sphere() && is_air(s.glass_after) &&
         is_air(lens.surfaces[k - 1].glass_after);
}

// Configures the lens with an auxiliary stop in front.
Result<LensState> set_up(Prescription lens) {
  for (const Surface& surface : lens.surfaces)
    if (surface.thickness_mm < 0.0)
      return failure(ErrorCode::Unsupported,
                     "no surface is the stop, and a gap is negative, as behind a mirror; lenses of refracting surfaces "
                     "alone are computed",
                     {lens.file.file, surface.source_line, 0});
  for (Surface& surface : lens.surfaces) {
    surface.semi_diameter_mm = kNoRim_mm;
    surface.aperture = {};
    surface.obscuration = {};
  }
  Surface stop;
  stop.kind = SurfaceKind::Stop;
  stop.semi_diameter_mm = kNoRim_mm;
  stop.source_line = lens.surfaces.front().source_line;
  stop.glass_after = air();
  lens.surfaces.insert(lens.surfaces.begin(), stop);
  for (ZoomPosition& position : lens.zoom)
    for (auto& [index, thickness_mm] : position.thickness_mm) ++index;
  lens.f_number = kAnyFNumber;
  if (const auto valid = validate(lens); !valid) return tl::unexpected(valid.error());
  auto state = configure_lens(lens, without_films());
  if (state) return state;
  return failure(ErrorCode::Unsupported, fmt::format("no surface is the stop, and {}", state.error().message),
                 {lens.file.file, stop.source_line, 0});
}

// A possible position of the stop: a distance behind a row's vertex.
struct GapPoint {
  std::size_t row = 0;
  double behind_mm = 0;
};

class StopFinder {
 public:
  StopFinder(const Prescription& lens, const LensState& state) : lens_(lens), rays_(rays_of(state)) {
    pupil_radius_mm_ = lens.f_number > 0.0 ? 0.5 * std::abs(state.focal_length_mm) / lens.f_number : widest_mm();
  }

  // None if no gap is wide enough.
  [[nodiscard]] std::optional<GapPoint> find() const {
    double length_mm = 0.0;
    for (std::size_t k = 0; k + 1 < lens_.surfaces.size(); ++k) length_mm += lens_.surfaces[k].thickness_mm;
    std::optional<GapPoint> best;
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k + 1 < lens_.surfaces.size(); ++k) {
      const double gap_mm = lens_.surfaces[k].thickness_mm;
      if (!is_air(lens_.surfaces[k].glass_after) || !(gap_mm >= kMinClearance * length_mm)) continue;
      for (const double fraction : kFractions) {
        const GapPoint gap_point{k, fraction * gap_mm};
        const double misfit = misfit_of(gap_point);
        if (misfit < smallest) {
          smallest = misfit;
          best = gap_point;
        }
      }
    }
    return best;
  }

  // The radius of the beam along the axis.
  [[nodiscard]] double beam_radius_mm(const GapPoint& gap_point) const {
    const RowRays& at = rays_[gap_point.row];
    return pupil_radius_mm_ * std::abs(at.axial + gap_point.behind_mm * at.axial_slope);
  }
  [[nodiscard]] double pupil_radius_mm() const { return pupil_radius_mm_; }

 private:
  [[nodiscard]] double widest_mm() const {
    double min_mm = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < rays_.size(); ++k) {
      const double rim_mm = lens_.surfaces[k].semi_diameter_mm;
      if (rim_mm > 0.0 && rays_[k].axial != 0.0) min_mm = std::min(min_mm, rim_mm / std::abs(rays_[k].axial));
    }
    return std::isfinite(min_mm) ? min_mm : kNoRim_mm;
  }

  // Sum of squares of the logarithms of rims over beam radii, for the field that fits best.
  [[nodiscard]] double misfit_of(const GapPoint& gap_point) const {
    const RowRays& at = rays_[gap_point.row];
    const double axial = at.axial + gap_point.behind_mm * at.axial_slope;
    const double tilted = at.tilted + gap_point.behind_mm * at.tilted_slope;
    double smallest = std::numeric_limits<double>::infinity();
    if (axial == 0.0) return smallest;
    for (int f = 1; f <= kFields; ++f) {
      const double slope = std::tan(kWidestField_rad * f / kFields);
      double sum = 0.0;
      for (std::size_t k = 0; k < rays_.size(); ++k) {
        const double rim_mm = lens_.surfaces[k].semi_diameter_mm;
        if (!(rim_mm > 0.0)) continue;
        const double chief = rays_[k].tilted - tilted / axial * rays_[k].axial;
        const double beam_mm = pupil_radius_mm_ * std::abs(rays_[k].axial) + slope * std::abs(chief);
        const double off = std::log(std::max(beam_mm, kNoRim_mm) / rim_mm);
        sum += off * off;
      }
      smallest = std::min(smallest, sum);
    }
    return smallest;
  }

  const Prescription& lens_;
  std::vector<RowRays> rays_;
  double pupil_radius_mm_ = 0;
};

void insert_stop(Prescription& lens, std::size_t at, Surface stop) {
  lens.surfaces.insert(lens.surfaces.begin() + static_cast<std::ptrdiff_t>(at), std::move(stop));
  for (ZoomPosition& position : lens.zoom)
    for (auto& [index, thickness_mm] : position.thickness_mm)
      if (index >= static_cast<int>(at)) ++index;
}

// An opening at either end of the gap, if there is one.
std::optional<std::size_t> adjacent_opening(const Prescription& lens, std::size_t row) {
  if (is_opening(lens, row)) return row;
  if (is_opening(lens, row + 1)) return row + 1;
  return std::nullopt;
}

bool is_zoom_gap(const Prescription& lens, std::size_t row) {
  if (lens.zoom.empty()) return false;
  const auto& moved = lens.zoom.front().thickness_mm;
  return std::any_of(moved.begin(), moved.end(), [&](const auto& gap) { return gap.first == static_cast<int>(row); });
}

constexpr const char* kRemedy = "mark the stop in the file to have it elsewhere";

// Makes the row the stop.
void make_stop(Prescription& lens, std::size_t row) {
  Surface& surface = lens.surfaces[row];
  surface.kind = SurfaceKind::Stop;
  surface.coating = {};
  lens.warnings.push_back(
      fmt::format("no surface is the stop; the opening {} (line {}) is taken for it, as the rims "
                  "of the surfaces say; {}",
                  row + 1, surface.source_line, kRemedy));
}

// The stop moves with the surfaces in front of it: where zooming changes the gap, the part behind the stop changes.
void put_stop(Prescription& lens, const GapPoint& gap_point, double radius_mm) {
  Surface& before = lens.surfaces[gap_point.row];
  Surface stop;
  stop.kind = SurfaceKind::Stop;
  stop.source_line = before.source_line;
  stop.glass_after = air();
  stop.semi_diameter_mm = lens.f_number > 0.0 ? 0.0 : radius_mm;
  const double behind_mm = is_zoom_gap(lens, gap_point.row) ? 0.0 : gap_point.behind_mm;
  stop.thickness_mm = before.thickness_mm - behind_mm;
  before.thickness_mm = behind_mm;
  lens.warnings.push_back(
      fmt::format("no surface is the stop; it is put {:.4g} mm behind surface {} (line {}), where "
                  "the rims of the surfaces say; {}",
                  behind_mm, gap_point.row + 1, before.source_line, kRemedy));
  const int moved = static_cast<int>(gap_point.row);
  insert_stop(lens, gap_point.row + 1, std::move(stop));
  for (ZoomPosition& position : lens.zoom)
    for (auto& [index, thickness_mm] : position.thickness_mm)
      if (index == moved) index = moved + 1;
}

void put_stop_in_front(Prescription& lens, double radius_mm) {
  Surface stop;
  stop.kind = SurfaceKind::Stop;
  stop.source_line = lens.surfaces.front().source_line;
  stop.glass_after = air();
  stop.semi_diameter_mm = lens.f_number > 0.0 ? 0.0 : radius_mm;
  lens.warnings.push_back(
      fmt::format("no surface is the stop, and no gap has room for an iris; it is put in front of "
                  "the first surface (line {}); {}",
                  stop.source_line, kRemedy));
  insert_stop(lens, 0, std::move(stop));
}

}  // namespace

Result<void> place_missing_stop(Prescription& lens) {
  if (lens.surfaces.empty() || has_stop(lens)) return {};
  const auto state = set_up(lens);
  if (!state) return tl::unexpected(state.error());
  const auto& stated_mm = lens.stated.focal_length_mm;
  if (stated_mm && !(std::abs(state->focal_length_mm / *stated_mm - 1.0) <= kSameFocalLength))
    return failure(
        ErrorCode::Unsupported,
        fmt::format("no surface is the stop, and the focal length is {:.4g} mm where {:g} mm is stated: this "
                    "is not all of the lens (a converter alone, or a mirror lens without its mirrors)",
                    state->focal_length_mm, *stated_mm),
        {lens.file.file, lens.surfaces.front().source_line, 0});
  const StopFinder finder(lens, *state);
  const auto gap_point = finder.find();
  if (!gap_point) {
    put_stop_in_front(lens, finder.pupil_radius_mm());
  } else if (const auto opening = adjacent_opening(lens, gap_point->row)) {
    make_stop(lens, *opening);
  } else {
    put_stop(lens, *gap_point, finder.beam_radius_mm(*gap_point));
  }
  return {};
}

}  // namespace contrejour::inline internal
