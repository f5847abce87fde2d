// SPDX-License-Identifier: Apache-2.0
#include "render/pupils/kept_pupils.h"

#include <utility>

namespace contrejour::inline internal::pupils {
namespace {

bool is_cancelled(const Context* context) { return context != nullptr && context->cancelled(); }

}  // namespace

KeptPupils::Key KeptPupils::key_of(const LensState& lens) {
  return {lens.surfaces,
          lens.stop_index,
          lens.stop_radius_mm,
          lens.sensor_z_mm,
          lens.design_wavelength_nm,
          lens.sensor_grating.orders,
          lens.sensor_grating.pitch_mm};
}

KeptPupils::PupilKey KeptPupils::key_of(const PupilRequest& request, Stage stage) {
  const LightSource& light = request.light;
  return {
      stage, request.ghost,
      NumberKey{light.direction.x, light.direction.y, light.direction.z, light.distance_mm, request.lambda_nm.front(),
                middle_wavelength(request), request.lambda_nm.back(), request.stop_times}};
}

KeptPupils::PupilKey KeptPupils::key_of(const WindowSearch& of) {
  const LightSource& light = of.light;
  const Iris& iris = of.iris;
  NumberKey key{light.direction.x,
                light.direction.y,
                light.direction.z,
                light.distance_mm,
                of.lambda_nm,
                of.stop_radius_mm,
                iris.rotation_rad,
                iris.curvature,
                iris.blade_radius,
                iris.asymmetry,
                1.0 * iris.blades,
                1.0 * iris.seed,
                1.0 * static_cast<int>(of.effort)};
  for (const double offset : iris.blade_offset) key.add(offset);
  return {Stage::OverWindow, of.ghost, std::move(key)};
}

template <class Make>
GhostPupil KeptPupils::get(const PupilRequest& request, Stage stage, const Make& make) {
  if (request.lambda_nm.empty()) return make();
  PupilKey key = key_of(request, stage);
  if (auto kept = pupils_.find(key)) return {*std::move(kept)};
  GhostPupil pupil = make();
  if (is_cancelled(request.context)) return pupil;
  pupils_.keep(std::move(key), pupil.boxes, kEntryBytes + pupil.boxes.size() * sizeof(Rectangle));
  return pupil;
}

GhostPupil KeptPupils::search_ghost_pupil(const PupilRequest& request) {
  return get(request, Stage::Searched, [&] { return pupils::search_ghost_pupil(request); });
}

GhostPupil KeptPupils::fit_ghost_pupil(const PupilRequest& request, GhostPupil searched) {
  return get(request, Stage::Fitted, [&] { return pupils::fit_ghost_pupil(request, std::move(searched)); });
}

GhostPupil KeptPupils::find_ghost_pupil(const PupilRequest& request) {
  return get(request, Stage::Fitted, [&] { return pupils::find_ghost_pupil(request); });
}

GhostPupil KeptPupils::refit_ghost_pupil(const PupilRequest& request, std::vector<Rectangle> boxes) {
  return get(request, Stage::Refitted, [&] { return pupils::refit_ghost_pupil(request, std::move(boxes)); });
}

Pupil KeptPupils::find_window_pupil(const WindowSearch& of, const std::function<Pupil()>& search) {
  if (of.iris.field) return search();
  PupilKey key = key_of(of);
  if (const auto kept = pupils_.find(key)) {
    if (kept->empty()) return {};
    return {{kept->front()}, kept->back(), 0};
  }
  Pupil pupil = search();
  if (is_cancelled(of.context)) return pupil;
  std::vector<Rectangle> figures = pupil.boxes;
  if (!figures.empty()) figures.push_back(pupil.sensor_mm);
  const std::size_t bytes = kEntryBytes + figures.size() * sizeof(Rectangle);
  pupils_.keep(std::move(key), std::move(figures), bytes);
  return pupil;
}

}  // namespace contrejour::inline internal::pupils
