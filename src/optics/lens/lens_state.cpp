// SPDX-License-Identifier: Apache-2.0
// Prescription -> LensState: zoom by interpolating between positions, focus by moving the sensor, stop radius
// from the f-number by a real marginal ray.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include <fmt/format.h>

#include "contrejour/expert/first_order.h"
#include "contrejour/lens.h"
#include "optics/lens/build_errors.h"
#include "optics/lens/iris_closing.h"
#include "optics/lens/sensor_stack.h"
#include "optics/lens/validate.h"
#include "optics/surface/shape-inl.h"

namespace contrejour {
namespace {

namespace hk = kernels::HWY_NAMESPACE;

constexpr double kNominalTolerance = 1e-6;   // relative: the same nominal focal length
constexpr double kPrimeTolerance = 5e-3;     // relative: asking a prime for its own focal length
constexpr double kFNumberTolerance = 5e-2;   // relative: lenses of 2.92 by patent are sold as 2.8
constexpr double kStopTolerance = 1e-2;  // relative: a smaller deviation of the stop from the widest f-number gives
                                         // no warning
constexpr int kZoomBisections = 60;  // to the last bit of the interpolation parameter

// Thicknesses at one zoom position, or between two.
std::vector<double> thicknesses(const Prescription& lens, std::size_t position, double towards_next) {
  std::vector<double> t;
  for (const Surface& s : lens.surfaces) t.push_back(s.thickness_mm);
  if (lens.zoom.empty()) return t;
  for (const auto& [k, value] : lens.zoom[position].thickness_mm) t[static_cast<std::size_t>(k)] = value;
  if (towards_next > 0.0) {
    const std::vector<double> next = thicknesses(lens, position + 1, 0.0);
    for (std::size_t k = 0; k < t.size(); ++k) t[k] = std::lerp(t[k], next[k], towards_next);
  }
  return t;
}

// Places coatings on their glasses; a design is computed once for each glass.
class CoatingPlacer {
 public:
  Coating position(const Coating& coating, const Glass& before, const Glass& after) {
    if (!std::holds_alternative<DesignedCoating>(coating.films)) return coating;
    for (const Placed& p : placed_)
      if (p.coating == coating && p.before == before && p.after == after) return p.result;
    placed_.push_back({coating, before, after, placed_on(coating, before, after)});
    return placed_.back().result;
  }

 private:
  struct Placed {
    Coating coating;
    Glass before, after;
    Coating result;
  };
  std::vector<Placed> placed_;
};

// The coating of a surface between two media: its own, or the one that the settings replace it by.
const Coating& coating_on(std::size_t index, const Surface& surface, bool borders_air, const LensSettings& settings) {
  const int number = static_cast<int>(index) + 1;
  const auto& own = settings.coating_at;
  const auto at = std::find_if(own.rbegin(), own.rend(), [&](const SurfaceCoating& c) { return c.surface == number; });
  if (at != own.rend()) return at->coating;
  const bool replaces = settings.coating && surface.kind == SurfaceKind::Refracting && borders_air;
  return replaces ? *settings.coating : surface.coating;
}

std::vector<SurfaceState> place_surfaces(const Prescription& lens, const std::vector<double>& thickness,
                                         const LensSettings& settings) {
  std::vector<SurfaceState> out;
  CoatingPlacer coatings;
  Glass medium = air();
  double z = 0.0;
  for (std::size_t k = 0; k < lens.surfaces.size(); ++k) {
    const Surface& s = lens.surfaces[k];
    const Glass after = s.kind == SurfaceKind::Stop ? medium : s.glass_after;
    const Coating& coating = coating_on(k, s, is_air(medium) != is_air(after), settings);
    out.push_back({s.kind, z, s.curvature_per_mm, s.semi_diameter_mm, medium, after,
                   coatings.position(coating, medium, after), s.pose, s.shape, s.aperture, s.obscuration});
    medium = after;
    z += thickness[k];
  }
  return out;
}

double focal_length_of(const std::vector<SurfaceState>& surfaces, double lambda_nm) {
  return -1.0 / abcd_between(surfaces, 0, static_cast<int>(surfaces.size()) - 1, lambda_nm).c;
}

struct ZoomSetting {
  std::size_t position = 0;
  double towards_next = 0.0;
  std::string warning;
};

double focal_length_at(const Prescription& lens, std::size_t position, double towards_next) {
  return focal_length_of(place_surfaces(lens, thicknesses(lens, position, towards_next), {}),
                         lens.stated.wavelength_nm);
}

// The interpolation parameter of a segment at which the computed focal length is the given one.
double solve_segment(const Prescription& lens, std::size_t position, double focal_length_mm) {
  double low = 0.0;
  double high = 1.0;
  const bool rising = focal_length_at(lens, position, 1.0) > focal_length_at(lens, position, 0.0);
  for (int k = 0; k < kZoomBisections; ++k) {
    const double middle = 0.5 * (low + high);
    const bool too_short = focal_length_at(lens, position, middle) < focal_length_mm;
    (too_short == rising ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Result<ZoomSetting> zoom_setting(const Prescription& lens, double focal_length_mm) {
  const auto& zoom = lens.zoom;
  for (std::size_t k = 0; k < zoom.size(); ++k) {
    if (std::abs(focal_length_mm / zoom[k].focal_length_mm - 1.0) < kNominalTolerance) return ZoomSetting{k, 0.0, {}};
  }
  std::vector<double> real;
  for (std::size_t k = 0; k < zoom.size(); ++k) real.push_back(focal_length_at(lens, k, 0.0));
  for (std::size_t k = 0; k + 1 < zoom.size(); ++k) {
    const auto [shorter, longer] = std::minmax(real[k], real[k + 1]);
    if (focal_length_mm >= shorter && focal_length_mm <= longer) {
      return ZoomSetting{k, solve_segment(lens, k, focal_length_mm), {}};
    }
  }
  const double shortest = std::min(zoom.front().focal_length_mm, real.front());
  const double longest = std::max(zoom.back().focal_length_mm, real.back());
  if (!(focal_length_mm >= shortest && focal_length_mm <= longest)) {
    return failure(ErrorCode::InvalidArgument,
                   fmt::format("focal length {:g} mm is outside this zoom's range; choose from {:g} to {:g} mm",
                               focal_length_mm, shortest, longest),
                   lens.file);
  }
  // The focal length is inside the engraved range but outside that of the prescription.
  const std::size_t end = focal_length_mm < real.front() ? 0 : zoom.size() - 1;
  return ZoomSetting{
      end, 0.0,
      fmt::format("asked for {:g} mm; the prescription's own limit is {:.2f} mm", focal_length_mm, real[end])};
}

Result<ZoomSetting> choose_zoom(const Prescription& lens, const std::optional<double>& focal_length_mm) {
  if (!lens.zoom.empty()) {
    return focal_length_mm ? zoom_setting(lens, *focal_length_mm) : Result<ZoomSetting>(ZoomSetting{});
  }
  if (!focal_length_mm) return ZoomSetting{};
  const double own = focal_length_at(lens, 0, 0.0);
  const double stated = lens.stated.focal_length_mm.value_or(own);
  if (std::abs(*focal_length_mm / own - 1.0) < kPrimeTolerance ||
      std::abs(*focal_length_mm / stated - 1.0) < kPrimeTolerance) {
    return ZoomSetting{};
  }
  return failure(ErrorCode::InvalidArgument,
                 fmt::format("this lens has one focal length, {:.2f} mm; leave the focal length out", own), lens.file);
}

hk::Hit<double> meet_centred(const hk::Ray3<double>& ray, const SurfaceState& s) {
  if (s.shape.is_sphere()) return hk::intersect(ray, s.z_mm, s.curvature_per_mm, 1.0);
  const ShapeConstants shape = shape_constants(s.curvature_per_mm, s.shape, s.semi_diameter_mm);
  return hk::intersect_shape(ray, s.z_mm, shape, 1.0, hk::exact_limits(shape));
}

// Height at the stop of the real ray parallel to the axis at height_mm; none if it does not reach the stop.
std::optional<double> marginal_height_at_stop(const LensState& lens, double height_mm) {
  hk::Ray3<double> ray{0.0, height_mm, lens.surfaces.front().z_mm, 0.0, 0.0, 1.0};
  for (int k = 0; k <= lens.stop_index; ++k) {
    const SurfaceState& s = lens.surfaces[static_cast<std::size_t>(k)];
    const auto hit = meet_centred(ray, s);
    if (hit.cos_in_squared <= 0.0) return std::nullopt;
    hk::move_to(ray, hit, s.z_mm);
    if (s.kind == SurfaceKind::Stop) continue;
    const double n_in = refractive_index(s.before, lens.design_wavelength_nm);
    const double n_out = refractive_index(s.after, lens.design_wavelength_nm);
    if (hk::refract(ray, hit, n_in / n_out, 1.0) <= 0.0) return std::nullopt;
  }
  return std::hypot(ray.x, ray.y);
}

// Radius of the round stop at this f-number.
double round_stop_mm(const LensState& lens, double f_number) {
  const double marginal_mm = 0.5 * std::abs(lens.focal_length_mm) / f_number;
  if (const auto height_mm = marginal_height_at_stop(lens, marginal_mm)) return *height_mm;
  return std::abs(abcd_between(lens.surfaces, 0, lens.stop_index, lens.design_wavelength_nm).a) * marginal_mm;
}

// The f-number at which the round stop has its surface's size, starting from one at which the stop would be too large.
double f_number_filling(const LensState& state, double stop_mm, double too_wide) {
  constexpr double kNarrow = 1000.0;
  constexpr int kHalvings = 60;
  double narrow = std::max(kNarrow, 2.0 * too_wide);
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = std::sqrt(too_wide * narrow);
    (round_stop_mm(state, middle) > stop_mm ? too_wide : narrow) = middle;
  }
  return narrow;
}

struct ImagePlane {
  double distant_mm = 0, image_mm = 0;  // from the last vertex: image of distant objects, image of this object
};
ImagePlane image_plane(const LensState& state, double object_distance_mm, Section section) {
  const Abcd m =
      abcd_between(state.surfaces, 0, static_cast<int>(state.surfaces.size()) - 1, state.design_wavelength_nm, section);
  const double distant_mm = -m.a / m.c;
  if (std::isinf(object_distance_mm)) return {distant_mm, distant_mm};
  // The ray from the axial object point: y = d u at the first vertex.
  return {distant_mm, -(m.a * object_distance_mm + m.b) / (m.c * object_distance_mm + m.d)};
}

bool images_distant_objects(const LensState& state) {
  return image_plane(state, std::numeric_limits<double>::infinity(), Section::Y).distant_mm > 0.0;
}

// A lens that forms no image has no marginal ray that determines the stop's size: its own size is then the widest, and
// it closes in proportion.
double wanted_stop_mm(const LensState& state, const Prescription& lens, double f_number) {
  if (images_distant_objects(state)) return round_stop_mm(state, f_number);
  return state.surfaces[static_cast<std::size_t>(state.stop_index)].semi_diameter_mm * lens.f_number / f_number;
}

Result<void> set_stop(LensState& state, const Prescription& lens, const std::optional<double>& f_number) {
  const SurfaceState& stop = state.surfaces[static_cast<std::size_t>(state.stop_index)];
  state.f_number = f_number.value_or(lens.f_number);
  if (!(state.f_number >= lens.f_number * (1.0 - kFNumberTolerance)) || state.f_number > kLargestFNumber) {
    return failure(ErrorCode::InvalidArgument,
                   fmt::format("f/{:g} is out of range; this lens opens to f/{:.3g}, choose that or a larger number",
                               state.f_number, lens.f_number),
                   lens.file);
  }
  state.f_number = std::max(state.f_number, lens.f_number);
  state.stop_radius_mm = wanted_stop_mm(state, lens, state.f_number);
  if (state.stop_radius_mm > stop.semi_diameter_mm) {
    if (state.stop_radius_mm > stop.semi_diameter_mm * (1.0 + kStopTolerance)) {
      const double widest_of_stop = f_number_filling(state, stop.semi_diameter_mm, state.f_number);
      state.warnings.push_back(
          fmt::format("f/{:g} needs a stop of {:.3f} mm radius; its widest opening of {:.3f} mm is used (f/{:.3g})",
                      state.f_number, state.stop_radius_mm, stop.semi_diameter_mm, widest_of_stop));
      state.f_number = widest_of_stop;
    }
    state.stop_radius_mm = stop.semi_diameter_mm;
  }
  return {};
}

// Called after the stop is set: the blades of a mechanism close over the stop's hole at the widest f-number.
Result<void> set_iris(LensState& state, const Prescription& lens, const LensSettings& settings) {
  if (const auto good = check_iris(settings.iris); !good) return good;
  state.iris = settings.iris;
  if (settings.iris_closing == IrisClosing::Scaled) return {};
  const double widest_mm = state.surfaces[static_cast<std::size_t>(state.stop_index)].semi_diameter_mm;
  const ClosedIris closed =
      close_iris(settings.iris, state.stop_radius_mm, std::min(widest_mm, wanted_stop_mm(state, lens, lens.f_number)));
  state.iris = closed.iris;
  state.stop_radius_mm = closed.stop_radius_mm;
  return {};
}

// Says which objects have an image behind the lens, if any: those at a distance d from the first vertex with -(a d + b)
// / (c d + d') > 0, by the lens's matrix.
std::string no_image_text(const LensState& state, double object_distance_mm) {
  const Abcd m =
      abcd_between(state.surfaces, 0, static_cast<int>(state.surfaces.size()) - 1, state.design_wavelength_nm);
  const std::string object = std::isinf(object_distance_mm)
                                 ? "distant objects"
                                 : fmt::format("an object {:g} mm in front of it", object_distance_mm);
  const std::string what = fmt::format("the lens forms no image of {} behind it", object);
  if (!(m.c < 0.0))
    return fmt::format(
        "{}, nor of any other, as its focal length is {:.4g} mm; check its radii, or give a converter or "
        "an attachment with its lens in one file",
        what, -1.0 / m.c);
  const double front_focus_mm = -m.d / m.c;  // of the first vertex, to the left positive
  const double min_mm = std::max(0.0, front_focus_mm);
  if (m.a > 0.0) return fmt::format("{}; focus farther away than its front focal point at {:.1f} mm", what, min_mm);
  const double max_mm = m.a < 0.0 ? -m.b / m.a : std::numeric_limits<double>::infinity();
  const double focus_mm = -m.a / m.c;
  if (max_mm > min_mm)
    return fmt::format(
        "{}: its rear focal point is at {:.4g} mm from the last surface; only objects from {:.1f} to "
        "{:.1f} mm in front of it have one",
        what, focus_mm, min_mm, max_mm);
  return fmt::format(
      "{}, nor of any other: its rear focal point is at {:.4g} mm from the last surface; check its radii "
      "and thicknesses",
      what, focus_mm);
}

// The sensor follows the paraxial image, half-way between the two images of the sections if they differ. A prescription
// that fixes the sensor's position for distant objects keeps its own defocus for near ones.
Result<void> set_focus(LensState& state, const Prescription& lens, double object_distance_mm) {
  const double last_z = state.surfaces.back().z_mm;
  state.object_distance_mm = object_distance_mm;
  ImagePlane plane = image_plane(state, object_distance_mm, Section::Y);
  if (!state.has_axial_symmetry()) {
    const ImagePlane in_x = image_plane(state, object_distance_mm, Section::X);
    plane = {std::midpoint(plane.distant_mm, in_x.distant_mm), std::midpoint(plane.image_mm, in_x.image_mm)};
  }
  double image_mm = plane.image_mm;
  if (lens.sensor_distance_mm) image_mm += *lens.sensor_distance_mm - plane.distant_mm;
  if (!(object_distance_mm > 0.0) || !std::isfinite(image_mm) || image_mm <= 0.0) {
    return failure(ErrorCode::InvalidArgument, no_image_text(state, object_distance_mm), lens.file);
  }
  state.sensor_z_mm = last_z + image_mm;
  return {};
}

// Warns of formulas that are used outside their stated range, within the visible lines g to C or at the design
// wavelength.
void warn_of_glasses(LensState& state) {
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const Glass& glass = state.surfaces[k].after;
    const auto range = wavelength_range_nm(glass);
    if (!range) continue;
    if (range->first_nm <= std::min(kLineG_nm, state.design_wavelength_nm) &&
        range->last_nm >= std::max(kLineC_nm, state.design_wavelength_nm))
      continue;
    state.warnings.push_back(
        fmt::format("surface {}: the formula of {} holds from {:g} to {:g} nm; beyond, its index is a guess", k + 1,
                    glass.name.empty() ? "its glass" : glass.name, range->first_nm, range->last_nm));
  }
}

// Warns if the stated figures differ from those of the surfaces, since published data are often wrong. If the back
// focal distance agrees, the surfaces are right, and the stated focal length is that of another lens or setting.
void warn_of_stated(LensState& state, const StatedFigures& stated) {
  const double back_mm = image_plane(state, std::numeric_limits<double>::infinity(), Section::Y).distant_mm;
  const auto is_as_stated = [&](const std::optional<double>& claimed_mm, double computed_mm) {
    return claimed_mm && std::abs(computed_mm - *claimed_mm) <= stated.tolerance * std::abs(state.focal_length_mm);
  };
  const auto compare = [&](const char* what, const std::optional<double>& claimed_mm, double computed_mm,
                           const char* more) {
    if (!claimed_mm || is_as_stated(claimed_mm, computed_mm)) return;
    state.warnings.push_back(fmt::format("its source states a {} of {:g} mm; the surfaces have {:.4g} mm{}", what,
                                         *claimed_mm, computed_mm, more));
  };
  compare("focal length", stated.focal_length_mm, state.focal_length_mm,
          is_as_stated(stated.back_focal_distance_mm, back_mm) ? ", and the stated back focal distance" : "");
  compare("back focal distance", stated.back_focal_distance_mm, back_mm, "");
}

Result<void> check_coatings(const Prescription& lens, const LensSettings& settings) {
  const auto refused = [&](const std::string& what) { return failure(ErrorCode::InvalidArgument, what, lens.file); };
  if (const auto problem = settings.coating ? coating_problem(*settings.coating) : std::nullopt)
    return refused("the coating: " + *problem);
  for (const SurfaceCoating& at : settings.coating_at) {
    const int count = static_cast<int>(lens.surfaces.size());
    if (at.surface < 1 || at.surface > count)
      return refused(fmt::format("a coating for surface {}: the lens has surfaces 1 to {}", at.surface, count));
    const auto k = static_cast<std::size_t>(at.surface - 1);
    if (lens.surfaces[k].kind == SurfaceKind::Stop)
      return refused(
          fmt::format("a coating for surface {}, which is the stop; `contrejour lens info` lists those of "
                      "glass",
                      at.surface));
    if (const auto problem = coating_problem(at.coating))
      return refused(fmt::format("the coating of surface {}: {}", at.surface, *problem));
  }
  return {};
}

// Errors for coatings between two equal media.
Result<void> check_coated(const LensState& state, const Prescription& lens, const LensSettings& settings) {
  for (const SurfaceCoating& at : settings.coating_at) {
    const SurfaceState& surface = state.surfaces[static_cast<std::size_t>(at.surface - 1)];
    if (surface.before == surface.after)
      return failure(ErrorCode::InvalidArgument,
                     fmt::format("a coating for surface {}, which is between two like media; `contrejour lens info` "
                                 "lists those that bound glass",
                                 at.surface),
                     lens.file);
  }
  return {};
}

}  // namespace

Result<LensState> configure_lens(const Prescription& lens, const LensSettings& settings) {
  if (const auto valid = validate(lens); !valid) return tl::unexpected<Error>(valid.error());
  if (const auto good = check_coatings(lens, settings); !good) return tl::unexpected<Error>(good.error());
  if (const auto good = check_build_errors(settings.build); !good) return tl::unexpected<Error>(good.error());
  if (const auto good = check_sensor_stack(settings.sensor); !good) return tl::unexpected<Error>(good.error());
  if (settings.coating) {
    if (const auto problem = coating_problem(*settings.coating)) return failure(ErrorCode::InvalidArgument, *problem);
  }
  const auto zoom = choose_zoom(lens, settings.focal_length_mm);
  if (!zoom) return tl::unexpected<Error>(zoom.error());

  LensState state;
  state.name = lens.name;
  state.warnings = lens.warnings;
  state.surfaces = place_surfaces(lens, thicknesses(lens, zoom->position, zoom->towards_next), settings);
  if (const auto good = check_coated(state, lens, settings); !good) return tl::unexpected<Error>(good.error());
  const auto stop = std::find_if(lens.surfaces.begin(), lens.surfaces.end(),
                                 [](const Surface& s) { return s.kind == SurfaceKind::Stop; });
  state.stop_index = static_cast<int>(stop - lens.surfaces.begin());
  state.sensor_width_mm = lens.sensor_width_mm;
  state.sensor_height_mm = lens.sensor_height_mm;
  state.design_wavelength_nm = lens.stated.wavelength_nm;
  state.focal_length_mm = focal_length_of(state.surfaces, state.design_wavelength_nm);
  if (!zoom->warning.empty()) state.warnings.push_back(zoom->warning);
  if (!std::isfinite(state.focal_length_mm)) {
    return failure(ErrorCode::InvalidArgument, "the lens has no power, so no focal length; check its radii", lens.file);
  }
  warn_of_glasses(state);
  if (zoom->position == 0 && zoom->towards_next == 0.0) warn_of_stated(state, lens.stated);
  if (const auto set = set_stop(state, lens, settings.f_number); !set) return tl::unexpected<Error>(set.error());
  if (const auto set = set_iris(state, lens, settings); !set) return tl::unexpected<Error>(set.error());
  if (const auto good = check_dirt(settings.dirt); !good) return tl::unexpected<Error>(good.error());
  state.dirt = settings.dirt;
  if (const auto set = set_focus(state, lens, settings.object_distance_mm); !set) {
    return tl::unexpected<Error>(set.error());
  }
  apply_build_errors(settings.build, state.surfaces);
  state.absorption = settings.absorption;
  if (const auto added = add_sensor_stack(settings.sensor, lens.file, state); !added)
    return tl::unexpected<Error>(added.error());
  return state;
}

}  // namespace contrejour
