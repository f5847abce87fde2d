// SPDX-License-Identifier: Apache-2.0
#include "optics/lens_files/sequential/design_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "base/units.h"
#include "contrejour/expert/first_order.h"

namespace contrejour::inline internal {
namespace {

constexpr double kNoFNumber = 1.0;  // for computations that do not depend on it
constexpr double kWidestHalfField_rad = 1.4;  // 80 degrees; a fisheye's rims are those of its file
constexpr double kRectilinear_rad = 1.05;  // 60 degrees; beyond, images of wide lenses are f times the angle, or less

// First-order properties of the lens. The matrix maps heights and slopes at its first row to those behind its last one.
struct Paraxial {
  Abcd through;
  double focal_mm = 0;
  double focus_mm = 0;  // behind the last row
  double pupil_mm = 0;  // first row -> entrance pupil
  double stop_per_pupil = 1;
  std::vector<double> axial;  // at each row, of a ray parallel to the axis, per height at the first
};

Result<Paraxial> paraxial(Prescription rows) {
  rows.f_number = kNoFNumber;
  rows.zoom.clear();
  rows.sensor_distance_mm.reset();
  for (Surface& surface : rows.surfaces) {
    surface.semi_diameter_mm = kNoRim_mm;
    surface.aperture = {};
    surface.obscuration = {};
  }
  if (const auto valid = validate(rows); !valid) return tl::unexpected(valid.error());
  const auto state = configure_lens(rows);
  if (!state)
    return failure(ErrorCode::Unsupported,
                   "it forms no image of distant objects behind it, as a negative or afocal lens, a single cylinder, a "
                   "window or a relay for near objects; flare is computed of lenses that do",
                   {rows.file.file, 0, 0});
  const double lambda_nm = state->design_wavelength_nm;
  const Abcd to_stop = abcd_between(state->surfaces, 0, state->stop_index, lambda_nm);
  const int last = static_cast<int>(state->surfaces.size()) - 1;
  std::vector<double> axial;
  for (int k = 0; k <= last; ++k) axial.push_back(std::abs(abcd_between(state->surfaces, 0, k, lambda_nm).a));
  return Paraxial{abcd_between(state->surfaces, 0, last, lambda_nm),
                  state->focal_length_mm,
                  state->sensor_z_mm - state->surfaces.back().z_mm,
                  to_stop.a == 0.0 ? 0.0 : to_stop.b / to_stop.a,
                  std::abs(to_stop.a),
                  std::move(axial)};
}

// The widest axial beam that all surfaces of known size transmit; 0 if no size is known.
double widest_beam_mm(const Prescription& rows, const Paraxial& lens) {
  double narrowest_mm = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < rows.surfaces.size(); ++k) {
    const double semi_mm = rows.surfaces[k].semi_diameter_mm;
    if (semi_mm > 0.0 && lens.axial[k] > 0.0) narrowest_mm = std::min(narrowest_mm, semi_mm / lens.axial[k]);
  }
  return std::isfinite(narrowest_mm) ? 2.0 * narrowest_mm : 0.0;
}

double stop_semi_mm(const Prescription& rows) {
  const auto stop = std::find_if(rows.surfaces.begin(), rows.surfaces.end(),
                                 [](const Surface& s) { return s.kind == SurfaceKind::Stop; });
  return stop == rows.surfaces.end() ? 0.0 : stop->semi_diameter_mm;
}

double pupil_diameter_mm(const SequentialDesign& design, const Prescription& rows, const Paraxial& lens,
                         double object_mm) {
  const double value = design.aperture_value;
  const bool near = std::isfinite(object_mm);
  const double to_pupil_mm = object_mm + lens.pupil_mm;
  switch (design.aperture) {
    case DesignAperture::Untold:
    case DesignAperture::ByStop: return 2.0 * stop_semi_mm(rows) / lens.stop_per_pupil;
    case DesignAperture::EntrancePupil: return value * design.unit_mm;
    case DesignAperture::FNumber: return std::abs(lens.focal_mm) / value;
    case DesignAperture::WorkingFNumber: {
      if (!near) return std::abs(lens.focal_mm) / value;
      const double slope = 0.5 / value / std::abs(lens.through.c * object_mm + lens.through.d);
      return 2.0 * to_pupil_mm * slope;
    }
    case DesignAperture::ObjectNA: return near ? 2.0 * to_pupil_mm * std::tan(std::asin(std::min(value, 0.99))) : 0.0;
  }
  return 0.0;
}

double half_field_rad(const SequentialDesign& design, const Paraxial& lens, double object_mm) {
  const double field = design.largest_field;
  const bool near = std::isfinite(object_mm);
  switch (design.field) {
    case FieldKind::Angle_deg: return rad_from_deg(field);
    case FieldKind::ObjectHeight: return near ? std::atan(field * design.unit_mm / (object_mm + lens.pupil_mm)) : 0.0;
    case FieldKind::ImageHeight: return std::atan(field * design.unit_mm / std::abs(lens.focal_mm));
  }
  return 0.0;
}

double image_radius_mm(const SequentialDesign& design, double half_field, double focal_mm) {
  if (design.largest_field == 0.0) return 0.0;
  if (design.field == FieldKind::ImageHeight) return design.largest_field * design.unit_mm;
  if (design.image_semi_diameter > 0.0) return design.image_semi_diameter * design.unit_mm;
  return std::abs(focal_mm) * (half_field > kRectilinear_rad ? half_field : std::tan(half_field));
}

}  // namespace

Result<DesignLight> light_of(const SequentialDesign& design, Prescription rows, double object_mm) {
  const auto lens = paraxial(rows);
  if (!lens) return tl::unexpected(lens.error());
  DesignLight light;
  light.focal_length_mm = lens->focal_mm;
  light.focus_mm = lens->focus_mm;
  light.stop_is_open = design.aperture == DesignAperture::ByStop && stop_semi_mm(rows) == 0.0;
  light.beam.pupil_diameter_mm =
      light.stop_is_open ? widest_beam_mm(rows, *lens) : pupil_diameter_mm(design, rows, *lens, object_mm);
  if (!(light.beam.pupil_diameter_mm > 0.0) || !std::isfinite(light.beam.pupil_diameter_mm))
    return failure(ErrorCode::Parse,
                   fmt::format("the lens's aperture is not told: neither an entrance pupil nor an f-number is given, "
                               "nor the stop's size; give one of them in {}",
                               design.program),
                   {design.file, 0, 0});
  const bool distant = std::isinf(object_mm);
  if (design.aperture == DesignAperture::FNumber || (design.aperture == DesignAperture::WorkingFNumber && distant)) {
    light.f_number = design.aperture_value;
  } else if (!design.is_by_stop()) {
    light.f_number = std::abs(lens->focal_mm) / light.beam.pupil_diameter_mm;
  }
  const double half_field = std::abs(half_field_rad(design, *lens, object_mm));
  light.beam.half_field_rad = std::min(half_field, kWidestHalfField_rad);
  light.image_radius_mm = image_radius_mm(design, half_field, lens->focal_mm);
  return light;
}

}  // namespace contrejour::inline internal
