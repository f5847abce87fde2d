// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "contrejour/expert/check_lens.h"
#include "contrejour/expert/trace.h"
#include "optics/surface/shape_constants.h"
#include "optics/trace/path_steps.h"

namespace contrejour::inline internal {
namespace {

double absorption_per_mm(const Glass& glass, double lambda_nm) {
  constexpr double kDarkest = 1e-30;
  return -std::log(std::max(kDarkest, internal_transmittance(glass, lambda_nm, 1.0)));
}

PathStep step_at(const LensState& lens, int surface, int direction, PathEvent event, double lambda_nm) {
  const SurfaceState& s = lens.surfaces[static_cast<std::size_t>(surface)];
  const double before = refractive_index(s.before, lambda_nm);
  const double after = refractive_index(s.after, lambda_nm);
  PathStep step;
  step.event = s.kind == SurfaceKind::Stop ? PathEvent::Stop : event;
  step.surface = surface;
  step.direction = direction;
  step.z_mm = s.z_mm;
  step.curvature_per_mm = s.curvature_per_mm;
  step.semi_diameter_mm = s.semi_diameter_mm;
  step.n_in = direction > 0 ? before : after;
  step.n_out = direction > 0 ? after : before;
  step.coating = at_wavelength(s.coating, lambda_nm);
  step.pose = s.pose;
  if (!s.shape.is_sphere()) {
    step.shape = std::make_shared<ShapeConstants>(shape_constants(s.curvature_per_mm, s.shape, s.semi_diameter_mm));
  }
  if (lens.absorption) step.absorption_per_mm = absorption_per_mm(direction > 0 ? s.before : s.after, lambda_nm);
  return step;
}

// Efficiency of one order of a grating of squares (fill: side over pitch), relative to all reflected light: the
// squares' spectrum sinc^2(m f) in each direction, normalised so that all orders sum to 1.
double order_efficiency(int order, double fill) {
  const double x = std::numbers::pi * order * fill;
  const double sinc = order == 0 ? 1.0 : std::sin(x) / x;
  return fill * sinc * sinc;
}

// Adds a rim in the medium in front of the step, reached after the path to the step.
void add_rim(OpticalPath& path, PathStep& step, const Rim& rim) {
  PathStep only = step;
  only.event = PathEvent::Refract;
  only.coating = {};
  only.n_out = only.n_in;
  only.rim = rim;
  only.is_rim_only = true;
  path.steps.push_back(std::move(only));
  step.absorption_per_mm = 0.0;
}

// Adds all rims but the last as steps of their own.
void add_rims(OpticalPath& path, PathStep& step, const std::vector<Rim>& rims) {
  if (rims.empty()) return;
  for (std::size_t k = 0; k + 1 < rims.size(); ++k) add_rim(path, step, rims[k]);
  step.rim = rims.back();
}

OpticalPath empty_path(const LensState& lens, double lambda_nm) {
  OpticalPath path;
  path.lambda_nm = lambda_nm;
  path.sensor_z_mm = lens.sensor_z_mm;
  path.stop_radius_mm = lens.stop_radius_mm;
  path.centred = std::ranges::all_of(lens.surfaces, &SurfaceState::is_centred);
  path.steps.reserve(3 * lens.surfaces.size());
  return path;
}

}  // namespace

void add_steps(OpticalPath& path, const LensState& lens, int surface, int direction, PathEvent event) {
  PathStep step = step_at(lens, surface, direction, event, path.lambda_nm);
  const SurfaceState& s = lens.surfaces[static_cast<std::size_t>(surface)];
  if (s.obscuration.any()) {
    add_rim(path, step, rim_of(s.obscuration));
    path.steps.back().blocks_within = path.obscured = true;
  }
  if (step.event != PathEvent::Stop) add_rims(path, step, rims_of(s.aperture, s.semi_diameter_mm));
  path.steps.push_back(std::move(step));
  if (path.steps.back().event == PathEvent::Stop) ++path.stop_crossings;
}

std::optional<GratingDeflection> grating_deflection(const LensState& lens, int surface, std::array<int, 2> order,
                                                    double lambda_nm) {
  const SensorGrating& grating = lens.sensor_grating;
  if (grating.orders == 0 || lens.surfaces[static_cast<std::size_t>(surface)].kind != SurfaceKind::Sensor)
    return std::nullopt;
  const double per_order = lambda_nm * 1e-6 / grating.pitch_mm;
  return GratingDeflection{{order[0] * per_order, order[1] * per_order},
                           order_efficiency(order[0], grating.fill) * order_efficiency(order[1], grating.fill)};
}

}  // namespace contrejour::inline internal

namespace contrejour {

OpticalPath direct_path(const LensState& lens, double lambda_nm) {
  OpticalPath path = empty_path(lens, lambda_nm);
  for (std::size_t k = 0; k < lens.surfaces.size(); ++k)
    if (lens.surfaces[k].kind != SurfaceKind::Sensor)
      add_steps(path, lens, static_cast<int>(k), +1, PathEvent::Refract);
  return path;
}

OpticalPath ghost_path(const LensState& lens, Ghost ghost, double lambda_nm) {
  OpticalPath path = empty_path(lens, lambda_nm);
  if (!has_surfaces_of(lens, ghost)) return path;
  walk_ghost(
      lens, ghost,
      [&](int surface, int direction, PathEvent event) { add_steps(path, lens, surface, direction, event); },
      [&](int surface, std::array<int, 2> order) {
        const auto deflection = grating_deflection(lens, surface, order, lambda_nm);
        if (!deflection) return;
        path.steps.back().grating_shift = deflection->grating_shift;
        path.steps.back().efficiency = deflection->efficiency;
      });
  return path;
}

OpticalPath without_obscurations(const OpticalPath& path) {
  OpticalPath out = path;
  out.obscured = false;
  out.steps.clear();
  double absorption_per_mm = 0.0;  // of the path to an omitted step
  for (const PathStep& step : path.steps) {
    if (step.blocks_within) {
      absorption_per_mm = step.absorption_per_mm;
      continue;
    }
    out.steps.push_back(step);
    out.steps.back().absorption_per_mm += std::exchange(absorption_per_mm, 0.0);
  }
  return out;
}

bool has_axial_symmetry(const LensState& lens, const Ghost& ghost) {
  const auto turns_at = [&](int surface) {
    return surface == ghost.j || (ghost.reflects_four_times() && surface == ghost.l);
  };
  int surface = 0;
  return std::all_of(lens.surfaces.begin(), lens.surfaces.end(), [&](const SurfaceState& s) {
    ++surface;
    return s.has_axial_symmetry() || (s.kind == SurfaceKind::Sensor && !turns_at(surface));
  });
}

}  // namespace contrejour
