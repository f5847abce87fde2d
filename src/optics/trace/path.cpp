#include <algorithm>
#include <cmath>
#include <memory>

#include "contrejour/trace.h"
#include "kernels/shape_constants.h"

namespace contrejour {
namespace {

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
  return step;
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
    for (int k = first; k <= last; ++k) add(k, +1, PathEvent::Refract);
  }
  void pass_backward(int first, int last) {
    for (int k = first; k >= last; --k) add(k, -1, PathEvent::Refract);
  }
  void reflect(int surface, int direction) { add(surface, direction, PathEvent::Reflect); }
  [[nodiscard]] OpticalPath take() { return std::move(path_); }

 private:
  void add(int surface, int direction, PathEvent event) {
    path_.steps.push_back(step_at(lens_, surface, direction, event, path_.lambda_nm));
    if (path_.steps.back().event == PathEvent::Stop) ++path_.stop_crossings;
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
  const int near = ghost.i - 1;
  const int far = ghost.j - 1;
  PathBuilder builder(lens, lambda_nm);
  builder.pass_forward(0, far - 1);
  builder.reflect(far, +1);
  builder.pass_backward(far - 1, near + 1);
  builder.reflect(near, -1);
  builder.pass_forward(near + 1, static_cast<int>(lens.surfaces.size()) - 1);
  return builder.take();
}

}  // namespace contrejour
