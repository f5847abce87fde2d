// SPDX-License-Identifier: Apache-2.0
#include "optics/lens/validate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <span>

#include <fmt/format.h>

#include "base/near_name.h"
#include "base/scalar.h"
#include "contrejour/lens.h"
#include "optics/lens/rims.h"

namespace contrejour::inline internal {

namespace {

// The range in which a glass must have an index.
constexpr double kVisibleFirst_nm = 380.0;
constexpr double kVisibleLast_nm = 780.0;
constexpr double kVisibleStep_nm = 20.0;
// Transparent solids have up to 2.7 in the visible; silicon and germanium, for infrared designs, up to 4.1.
constexpr double kMaxGlassIndex = 5.0;
constexpr double kMaxFilmIndex = 8.0;
constexpr double kMinFilmIndex = 0.01;  // silver
constexpr double kMaxFilm_nm = 1e5;     // thicker films are glass
constexpr double kMaxLength_mm = 1e5;
constexpr double kMaxConic = 1e6;       // of a nearly flat surface; real ones stay below 1000
constexpr double kMaxCurvature_per_mm = 1e6;  // no smaller clear aperture exists
constexpr double kMaxAngle_rad = 1e3;    // beyond, angles lose digits
constexpr double kMinUpright = 0.5;   // z of a surface's axis
constexpr double kMaxFNumber = 1000.0;
constexpr double kMinFNumber = 0.4;  // 0.5 is the limit of an aplanat in air; patents round

// Makes the error of a broken rule, with the line and number of surface `index`.
struct RowFailure {
  const Prescription& lens;

  [[nodiscard]] tl::unexpected<Error> at(std::size_t index, const std::string& message) const {
    return failure(ErrorCode::InvalidArgument, fmt::format("surface {}: {}", index + 1, message),
                   {lens.file.file, lens.surfaces[index].source_line, 0});
  }
  [[nodiscard]] tl::unexpected<Error> at_line(int line, std::string message) const {
    return failure(ErrorCode::InvalidArgument, std::move(message), {lens.file.file, line, 0});
  }
};

Result<void> check_lens_values(const Prescription& lens) {
  const RowFailure fail{lens};
  if (!within(lens.f_number, kMinFNumber, kMaxFNumber)) {
    return fail.at_line(lens.file.line, fmt::format("f_number is {}; give the widest, from {} to {}", lens.f_number,
                                                    kMinFNumber, kMaxFNumber));
  }
  if (!within(lens.sensor_width_mm, 0.1, 1e4) || !within(lens.sensor_height_mm, 0.1, 1e4)) {
    return fail.at_line(lens.file.line, fmt::format("the sensor is {} x {} mm; give sizes from 0.1 to 10000 mm",
                                                    lens.sensor_width_mm, lens.sensor_height_mm));
  }
  if (lens.sensor_distance_mm && !within(*lens.sensor_distance_mm, 1e-6, kMaxLength_mm)) {
    return fail.at_line(lens.file.line, fmt::format("sensor_distance_mm is {}; give the distance from the last vertex",
                                                    *lens.sensor_distance_mm));
  }
  const StatedFigures& stated = lens.stated;
  const bool focal_fits = !stated.focal_length_mm || within(std::abs(*stated.focal_length_mm), 1e-3, kMaxLength_mm);
  const bool back_fits =
      !stated.back_focal_distance_mm || within(std::abs(*stated.back_focal_distance_mm), 0.0, kMaxLength_mm);
  if (!focal_fits || !back_fits || !within(stated.wavelength_nm, 300.0, 1100.0) || !(stated.tolerance > 0.0)) {
    return fail.at_line(lens.file.line, "a stated figure is zero, not finite or too large; correct it or leave it out");
  }
  return {};
}

Result<void> check_surface(const Prescription& lens, std::size_t i) {
  const RowFailure fail{lens};
  const Surface& s = lens.surfaces[i];
  const Glass before = i == 0 ? air() : lens.surfaces[i - 1].glass_after;
  const double semi_mm = s.semi_diameter_mm;
  if (!within(semi_mm, 1e-6, kMaxLength_mm)) {
    return fail.at(i,
                   fmt::format("semi_diameter_mm is {}; give the radius of the clear aperture, more than 0", semi_mm));
  }
  if (!within(s.thickness_mm, 0.0, kMaxLength_mm)) {
    return fail.at(i,
                   fmt::format("thickness_mm is {}; give the distance to the next vertex, 0 or more", s.thickness_mm));
  }
  if (const auto problem = shape_problem(s)) return fail.at(i, *problem);
  if (const auto problem = aperture_problem(s)) return fail.at(i, *problem);
  if (const auto problem = obscuration_problem(s)) return fail.at(i, *problem);
  if (s.shape.is_sphere() && !(std::abs(s.curvature_per_mm) * semi_mm <= 1.0)) {
    return fail.at(i, fmt::format("radius {:.6g} mm is smaller than semi_diameter_mm {:.6g}: a sphere has no rim "
                                  "there; make the semi-diameter smaller",
                                  1.0 / s.curvature_per_mm, semi_mm));
  }
  const bool plain = s.curvature_per_mm == 0.0 && s.shape == SurfaceShape{} && s.pose == SurfacePose{} &&
                     s.aperture == ClearAperture{};
  if (s.kind == SurfaceKind::Stop && (!plain || !(s.glass_after == before))) {
    return fail.at(i,
                   "a stop is flat and round, stands about the axis and has the same medium before and behind; make "
                   "it so (the iris gives the opening's shape)");
  }
  if (const auto problem = glass_problem(s.glass_after)) return fail.at(i, *problem);
  if (const auto problem = coating_problem(s.coating)) return fail.at(i, *problem);
  return {};
}

Result<void> check_rows(const Prescription& lens) {
  const RowFailure fail{lens};
  const std::vector<Surface>& rows = lens.surfaces;
  if (rows.empty()) return fail.at_line(lens.file.line, "no surfaces; list them from the front to the back");
  if (rows.size() > static_cast<std::size_t>(kMaxSurfaces)) {
    return fail.at_line(lens.file.line, fmt::format("{} surfaces; at most {} are computed", rows.size(), kMaxSurfaces));
  }
  int stops = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (const auto row = check_surface(lens, i); !row) return row;
    if (rows[i].kind == SurfaceKind::Stop && ++stops == 2) {
      return fail.at(i, "a second stop; keep the one that the iris closes and leave the other out");
    }
  }
  if (stops == 0) {
    return fail.at_line(rows.front().source_line,
                        "the lens has no stop; add a row { stop = true, semi_diameter_mm = "
                        "..., thickness_mm = ... } where the iris is");
  }
  if (rows.size() == 1) return fail.at(0, "a stop alone is no lens; add its surfaces");
  if (!is_air(rows.back().glass_after)) {
    return fail.at(rows.size() - 1, "the last surface must be followed by air; leave its glass out");
  }
  return {};
}

Result<void> check_pair(const Prescription& lens, std::size_t front, std::size_t back, double thickness_mm,
                        const std::string& where) {
  const Surface &before = lens.surfaces[front], &behind = lens.surfaces[back];
  const Gap smallest =
      smallest_gap(before, behind, thickness_mm, std::min(before.semi_diameter_mm, behind.semi_diameter_mm));
  if (smallest.gap_mm >= -kTouch_mm) return {};
  return RowFailure{lens}.at(back, fmt::format("it crosses surface {} by {:.3g} mm inside the clear aperture (at "
                                               "height {:.6g} mm{}); make a semi-diameter smaller or check the "
                                               "radii and the thickness",
                                               front + 1, -smallest.gap_mm, smallest.height_mm, where));
}

Result<void> check_crossings(const Prescription& lens, std::span<const double> thickness_mm, const std::string& where) {
  Result<void> checked;
  for_each_neighbours(lens.surfaces, thickness_mm, [&](std::size_t front, std::size_t back, double gap_mm) {
    checked = check_pair(lens, front, back, gap_mm, where);
    return checked.has_value();
  });
  return checked;
}

std::set<int> gaps_of(const ZoomPosition& position) {
  std::set<int> gaps;
  for (const auto& [index, thickness] : position.thickness_mm) gaps.insert(index);
  return gaps;
}

Result<void> check_zoom_values(const Prescription& lens, const ZoomPosition& position, std::size_t number) {
  const RowFailure fail{lens};
  if (!within(position.focal_length_mm, 1e-3, kMaxLength_mm)) {
    return fail.at_line(
        position.source_line,
        fmt::format("zoom position {}: focal_length_mm is {}; give one more than 0", number, position.focal_length_mm));
  }
  if (position.thickness_mm.empty() || gaps_of(position).size() != position.thickness_mm.size()) {
    return fail.at_line(position.source_line, fmt::format("zoom position {}: give each gap that moves, once", number));
  }
  for (const auto& [index, thickness_mm] : position.thickness_mm) {
    if (index < 0 || index + 1 >= static_cast<int>(lens.surfaces.size())) {
      return fail.at_line(position.source_line,
                          fmt::format("zoom position {}: no gap is behind surface {}; gaps are 1 to {}", number,
                                      index + 1, lens.surfaces.size() - 1));
    }
    if (!within(thickness_mm, 0.0, kMaxLength_mm)) {
      return fail.at_line(position.source_line,
                          fmt::format("zoom position {}: the thickness behind surface {} is {}; give 0 or more", number,
                                      index + 1, thickness_mm));
    }
  }
  return {};
}

Result<void> check_zoom_order(const Prescription& lens) {
  const RowFailure fail{lens};
  for (std::size_t z = 1; z < lens.zoom.size(); ++z) {
    const ZoomPosition& now = lens.zoom[z];
    if (!(now.focal_length_mm > lens.zoom[z - 1].focal_length_mm)) {
      return fail.at_line(now.source_line,
                          fmt::format("zoom position {}: {} mm after {} mm; list the positions from the "
                                      "shortest to the longest",
                                      z + 1, now.focal_length_mm, lens.zoom[z - 1].focal_length_mm));
    }
    if (gaps_of(now) != gaps_of(lens.zoom.front())) {
      return fail.at_line(now.source_line,
                          fmt::format("zoom position {}: it moves other gaps than position 1; give the "
                                      "same ones at every position",
                                      z + 1));
    }
  }
  return {};
}

Result<void> check_zoom(const Prescription& lens) {
  const RowFailure fail{lens};
  if (lens.zoom.size() == 1 || lens.zoom.size() > static_cast<std::size_t>(kMaxZoomPositions)) {
    return fail.at_line(lens.zoom.front().source_line,
                        fmt::format("{} zoom positions; give 2 to {}, or none", lens.zoom.size(), kMaxZoomPositions));
  }
  for (std::size_t z = 0; z < lens.zoom.size(); ++z) {
    if (const auto values = check_zoom_values(lens, lens.zoom[z], z + 1); !values) return values;
  }
  return check_zoom_order(lens);
}

}  // namespace

std::optional<std::string> glass_problem(const Glass& glass) {
  if (const auto* abbe = std::get_if<AbbeGlass>(&glass.dispersion)) {
    const bool fits = abbe->v_d == 0.0 || within(abbe->v_d, 5.0, 200.0);
    if (!fits) return fmt::format("v_d is {}; an Abbe number is from 5 to 200", abbe->v_d);
  }
  if (const auto* model = std::get_if<ModelGlass>(&glass.dispersion)) {
    const bool fits = (model->v_d == 0.0 || within(model->v_d, 5.0, 200.0)) && within(model->d_pgf, -1.0, 1.0);
    if (!fits) {
      return fmt::format("v_d is {} and d_pgf {}; an Abbe number is from 5 to 200, a deviation from -1 to 1",
                         model->v_d, model->d_pgf);
    }
  }
  if (const auto* sellmeier = std::get_if<Sellmeier>(&glass.dispersion)) {
    for (const double c_um2 : sellmeier->c_um2) {
      // A resonance inside the visible: no glass, and an index without bound between the samples below.
      if (!within(c_um2, 0.0, 1e6) || within(std::sqrt(c_um2), kVisibleFirst_nm / 1e3, kVisibleLast_nm / 1e3)) {
        return fmt::format("sellmeier_c_um2 has {}; give squares of wavelengths (um^2) outside the visible", c_um2);
      }
    }
  }
  for (double nm = kVisibleFirst_nm; nm <= kVisibleLast_nm; nm += kVisibleStep_nm) {
    const double n = refractive_index(glass, nm);
    if (!within(n, 1.0, kMaxGlassIndex)) {
      return fmt::format("the glass's index is {:.6g} at {} nm; it must be from 1 to {}: check its figures", n, nm,
                         kMaxGlassIndex);
    }
  }
  return std::nullopt;
}

namespace {

bool rising(const std::vector<double>& list, double low, double high) {
  for (std::size_t k = 0; k < list.size(); ++k)
    if (!within(list[k], low, high) || (k > 0 && !(list[k] > list[k - 1]))) return false;
  return !list.empty() && list.size() <= kMaxMeasured;
}

std::optional<std::string> measured_problem(const MeasuredCoating& measured) {
  if (!rising(measured.lambda_nm, 100.0, 20000.0)) {
    return fmt::format("measured wavelengths must rise from 100 nm or more to 20000 nm at the most, 1 to {} of them",
                       kMaxMeasured);
  }
  if (!rising(measured.angle_deg, 0.0, 90.0))
    return fmt::format("measured angles must rise within 0 to 90 degrees, 1 to {} of them", kMaxMeasured);
  const std::size_t wanted = measured.lambda_nm.size() * measured.angle_deg.size();
  const auto fits = [](double r) { return within(r, 0.0, 1.0); };
  if (measured.reflectance.size() == wanted &&
      std::all_of(measured.reflectance.begin(), measured.reflectance.end(), fits))
    return std::nullopt;
  return fmt::format("{} reflectances; give {}, each from 0 to 1", measured.reflectance.size(), wanted);
}

std::string unknown_material(const std::string& name) {
  std::vector<std::string_view> names;
  for (const FilmMaterialFacts& facts : film_materials()) names.push_back(facts.name);
  const std::string near = nearest_name(name, names);
  return fmt::format("no film material is called '{}'; {}", shortened(name),
                     near.empty() ? "give its index instead" : fmt::format("did you mean '{}'?", near));
}

}  // namespace

std::optional<std::string> shape_problem(const Surface& surface) {
  const SurfaceShape& shape = surface.shape;
  const bool symmetric = shape.has_axial_symmetry();
  if (!within(shape.conic, -kMaxConic, kMaxConic) || !within(shape.conic_x, -kMaxConic, kMaxConic)) {
    return fmt::format("a conic constant is {}; give one from {} to {}",
                       within(shape.conic, -kMaxConic, kMaxConic) ? shape.conic_x : shape.conic, -kMaxConic, kMaxConic);
  }
  if (shape.powers.size() > static_cast<std::size_t>(SurfaceShape::kHighestPower)) {
    return fmt::format("an asphere's powers go to {}; at most {} is computed", shape.powers.size(),
                       SurfaceShape::kHighestPower);
  }
  if (!std::all_of(shape.powers.begin(), shape.powers.end(), [](double a) { return std::isfinite(a); }) ||
      !std::isfinite(shape.curvature_x_per_mm) || !within(shape.rotation_rad, -kMaxAngle_rad, kMaxAngle_rad)) {
    return "a number of the surface's shape is not finite, or too large; correct it";
  }
  if (!within(surface.curvature_per_mm, -kMaxCurvature_per_mm, kMaxCurvature_per_mm) ||
      !within(shape.curvature_x_per_mm, -kMaxCurvature_per_mm, kMaxCurvature_per_mm)) {
    return fmt::format("a radius is less than {} mm; correct it", 1.0 / kMaxCurvature_per_mm);
  }
  const bool has_powers = std::any_of(shape.powers.begin(), shape.powers.end(), [](double a) { return a != 0.0; });
  const bool has_x = shape.curvature_x_per_mm != 0.0 || shape.rotation_rad != 0.0;
  if ((symmetric && has_x) || (shape.kind != ShapeKind::Biconic && shape.conic_x != 0.0) ||
      (shape.kind == ShapeKind::Biconic && has_powers)) {
    return "a number that a surface of this shape does not have: only a toroid and a biconic have a second radius, "
           "only "
           "a biconic a second conic constant and only the others powers";
  }
  const Vec3 axis = surface.pose.axis;
  const Vec3 shift = surface.pose.shift_mm;
  const bool stands = within(shift.x, -kMaxLength_mm, kMaxLength_mm) &&
                      within(shift.y, -kMaxLength_mm, kMaxLength_mm) && within(shift.z, -kMaxLength_mm, kMaxLength_mm);
  if (!stands || !(std::abs(length(axis) - 1.0) < 1e-9) || !(axis.z >= kMinUpright)) {
    return fmt::format(
        "it stands {:.4g} mm aside with its axis along ({:.4g}, {:.4g}, {:.4g}); tilt it by 60 degrees at "
        "most",
        std::hypot(shift.x, shift.y), axis.x, axis.y, axis.z);
  }
  if (!shape.is_sphere() && !reaches(surface, surface.semi_diameter_mm)) {
    return fmt::format(
        "the surface ends before semi_diameter_mm {:.6g}: a root of its formula is of a negative number "
        "there; make the semi-diameter smaller or check the conic constant",
        surface.semi_diameter_mm);
  }
  return std::nullopt;
}

std::optional<std::string> aperture_problem(const Surface& surface) {
  const ClearAperture& a = surface.aperture;
  if (a == ClearAperture{}) return std::nullopt;
  const bool fits = a.kind != ApertureKind::Disc && within(a.half_mm.x, 1e-6, kMaxLength_mm) &&
                    within(a.half_mm.y, 1e-6, kMaxLength_mm) && length(a.centre_mm) < surface.semi_diameter_mm &&
                    within(a.rotation_rad, -kMaxAngle_rad, kMaxAngle_rad);
  if (fits) return std::nullopt;
  return fmt::format(
      "a rim of half sides {} and {} mm about ({}, {}); give half sides of more than 0 about a place "
      "within semi_diameter_mm",
      a.half_mm.x, a.half_mm.y, a.centre_mm.x, a.centre_mm.y);
}

std::optional<std::string> obscuration_problem(const Surface& surface) {
  const Obscuration& o = surface.obscuration;
  if (o == Obscuration{}) return std::nullopt;
  if (!within(o.half_mm.x, 1e-6, kMaxLength_mm) || !within(o.half_mm.y, 1e-6, kMaxLength_mm) ||
      !(length(o.centre_mm) <= surface.semi_diameter_mm) || !within(o.rotation_rad, -kMaxAngle_rad, kMaxAngle_rad)) {
    return fmt::format(
        "an obscuration of half sides {} and {} mm about ({}, {}); give half sides of more than 0 about a place within "
        "semi_diameter_mm",
        o.half_mm.x, o.half_mm.y, o.centre_mm.x, o.centre_mm.y);
  }
  if (std::min(o.half_mm.x, o.half_mm.y) - length(o.centre_mm) < surface.semi_diameter_mm) return std::nullopt;
  return fmt::format(
      "an obscuration of {:.6g} mm covers all of the surface, whose semi_diameter_mm is {:.6g}; make it "
      "smaller",
      std::min(o.half_mm.x, o.half_mm.y), surface.semi_diameter_mm);
}

std::optional<std::string> coating_problem(const Coating& coating) {
  const auto single = [](double n, double nm) -> std::optional<std::string> {
    if (within(n, 1.0, kMaxFilmIndex) && within(nm, 100.0, 5000.0)) return std::nullopt;
    return fmt::format("a film of index {} for {} nm; give an index from 1 to {} and a wavelength from 100 to 5000 nm",
                       n, nm, kMaxFilmIndex);
  };
  if (const auto* quarter = std::get_if<QuarterWave>(&coating.films)) return single(quarter->n, quarter->lambda0_nm);
  if (const auto* hullin = std::get_if<HullinFresnelAR>(&coating.films)) return single(hullin->n, hullin->lambda0_nm);
  if (const auto* design = std::get_if<DesignedCoating>(&coating.films)) return single(1.0, design->lambda0_nm);
  if (const auto* measured = std::get_if<MeasuredCoating>(&coating.films)) return measured_problem(*measured);
  const auto* stack = std::get_if<FilmStack>(&coating.films);
  if (stack == nullptr) return std::nullopt;
  if (stack->layers.empty() || stack->layers.size() > static_cast<std::size_t>(kMaxFilmLayers)) {
    return fmt::format("a stack of {} layers; give 1 to {}, or \"none\"", stack->layers.size(), kMaxFilmLayers);
  }
  for (const FilmLayer& layer : stack->layers) {
    const FilmMaterial& m = layer.material;
    if (!m.name.empty() && !is_film_material(m.name)) return unknown_material(m.name);
    const bool fits = within(m.n.real(), kMinFilmIndex, kMaxFilmIndex) && within(m.n.imag(), 0.0, 20.0) &&
                      within(layer.thickness_nm, 0.0, kMaxFilm_nm);
    if (!fits) {
      return fmt::format("a layer of n = {}, k = {}, {} nm; give n from {} to {}, k from 0 to 20 and at most {} nm",
                         m.n.real(), m.n.imag(), layer.thickness_nm, kMinFilmIndex, kMaxFilmIndex, kMaxFilm_nm);
    }
  }
  return std::nullopt;
}

}  // namespace contrejour::inline internal

namespace contrejour {

Result<void> validate(const Prescription& lens) {
  if (const auto values = check_lens_values(lens); !values) return values;
  if (const auto rows = check_rows(lens); !rows) return rows;
  if (!lens.zoom.empty()) {
    if (const auto zoom = check_zoom(lens); !zoom) return zoom;
  }
  const auto thicknesses = thicknesses_of(lens);
  for (std::size_t z = 0; z < thicknesses.size(); ++z) {
    const std::string where = lens.zoom.empty() ? "" : fmt::format(", zoomed to {:g} mm", lens.zoom[z].focal_length_mm);
    if (const auto crossings = check_crossings(lens, thicknesses[z], where); !crossings) return crossings;
  }
  return {};
}

}  // namespace contrejour
