#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "contrejour/trace.h"
#include "kernels/shape_constants.h"

namespace contrejour {
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

// Of the light that a grating of squares reflects (side over pitch: fill), the share in one order: the squares'
// spectrum sinc^2(m f) in each direction, all orders' adding up to 1.
double share_of_order(int order, double fill) {
  const double x = std::numbers::pi * order * fill;
  const double sinc = order == 0 ? 1.0 : std::sin(x) / x;
  return fill * sinc * sinc;
}

class PathBuilder {
 public:
  PathBuilder(const LensState& lens, double lambda_nm) : lens_(lens) {
    path_.lambda_nm = lambda_nm;
    path_.sensor_z_mm = lens.sensor_z_mm;
    path_.stop_radius_mm = lens.stop_radius_mm;
    path_.centred =
        std::all_of(lens.surfaces.begin(), lens.surfaces.end(), [](const SurfaceState& s) { return s.is_centred(); });
    path_.steps.reserve(3 * lens.surfaces.size());
  }

  // Refracts at every surface from first to last, which may be none.
  void pass_forward(int first, int last) {
    for (int k = first; k <= last; ++k)
      if (lens_.surfaces[static_cast<std::size_t>(k)].kind != SurfaceKind::Sensor) add(k, +1, PathEvent::Refract);
  }
  void pass_backward(int first, int last) {
    for (int k = first; k >= last; --k) add(k, -1, PathEvent::Refract);
  }
  void reflect(int surface, int direction) { add(surface, direction, PathEvent::Reflect); }
  void reflect_by_grating(int surface, std::array<int, 2> order) {
    reflect(surface, +1);
    const SensorGrating& grating = lens_.sensor_grating;
    if (grating.orders == 0 || lens_.surfaces[static_cast<std::size_t>(surface)].kind != SurfaceKind::Sensor) return;
    PathStep& step = path_.steps.back();
    const double per_order = path_.lambda_nm * 1e-6 / grating.pitch_mm;
    step.kick = {order[0] * per_order, order[1] * per_order};
    step.share = share_of_order(order[0], grating.fill) * share_of_order(order[1], grating.fill);
  }
  [[nodiscard]] OpticalPath take() { return std::move(path_); }

 private:
  void add(int surface, int direction, PathEvent event) {
    PathStep step = step_at(lens_, surface, direction, event, path_.lambda_nm);
    const SurfaceState& s = lens_.surfaces[static_cast<std::size_t>(surface)];
    if (s.obscuration.any()) {
      add_rim(step, rim_of(s.obscuration));
      path_.steps.back().blocks_within = path_.obscured = true;
    }
    if (step.event != PathEvent::Stop) add_rims(step, rims_of(s.aperture, s.semi_diameter_mm));
    path_.steps.push_back(std::move(step));
    if (path_.steps.back().event == PathEvent::Stop) ++path_.stop_crossings;
  }

  // All but the last become steps of their own.
  void add_rims(PathStep& step, const std::vector<Rim>& rims) {
    if (rims.empty()) return;
    for (std::size_t k = 0; k + 1 < rims.size(); ++k) add_rim(step, rims[k]);
    step.rim = rims.back();
  }

  // In the medium before the step, and after the way to it.
  void add_rim(PathStep& step, const Rim& rim) {
    PathStep only = step;
    only.event = PathEvent::Refract;
    only.coating = {};
    only.n_out = only.n_in;
    only.rim = rim;
    only.is_rim_only = true;
    path_.steps.push_back(std::move(only));
    step.absorption_per_mm = 0.0;
  }

  const LensState& lens_;
  OpticalPath path_;
};

}  // namespace

OpticalPath direct_path(const LensState& lens, double lambda_nm) {
  PathBuilder builder(lens, lambda_nm);
  builder.pass_forward(0, static_cast<int>(lens.surfaces.size()) - 1);
  return builder.take();
}

OpticalPath ghost_path(const LensState& lens, Ghost ghost, double lambda_nm) {
  PathBuilder builder(lens, lambda_nm);
  int behind = -1;  // the surface that the light comes from, forward
  const auto there_and_back = [&](int far, int near, std::array<int, 2> order) {
    builder.pass_forward(behind + 1, far - 1);
    builder.reflect_by_grating(far, order);
    builder.pass_backward(far - 1, near + 1);
    builder.reflect(near, -1);
    behind = near;
  };
  there_and_back(ghost.j - 1, ghost.i - 1, ghost.order);
  if (ghost.reflects_four_times()) there_and_back(ghost.l - 1, ghost.k - 1, {0, 0});
  builder.pass_forward(behind + 1, static_cast<int>(lens.surfaces.size()) - 1);
  return builder.take();
}

OpticalPath without_obscurations(const OpticalPath& path) {
  OpticalPath out = path;
  out.obscured = false;
  out.steps.clear();
  double absorption_per_mm = 0.0;  // on the way to a step left out
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
