// SPDX-License-Identifier: Apache-2.0
// A ghost's exact rays, shared by the tests of pupils, of maps through their rays and of `adaptive`.
#pragma once

#include <utility>
#include <vector>

#include "optics/trace/by_wavelength.h"
#include "render/pupils/pupil_search.h"
#include "render/ray_maps/lobatto_rays.h"
#include "support/scenes.h"

namespace contrejour::test {

inline LensState lens_at_f(const char* name, double f_number, double focal_length_mm = 0.0, Iris iris = {}) {
  LensSettings settings;
  settings.f_number = f_number;
  if (focal_length_mm > 0.0) settings.focal_length_mm = focal_length_mm;
  settings.iris = iris;
  return bundled(name, settings);
}

// Rays of one ghost and light at one wavelength, ready for ray sets.
struct GhostScene {
  LensState lens;
  Ghost ghost;
  double lambda_nm = 550.0;
  Vec3 direction;  // of the light, as in the lens's own coordinates
  LightFrame light;
  EntranceWindow window;
  OpticalPath path;
  TablesByWavelength tables;
  std::vector<Rectangle> boxes;

  GhostScene(LensState state, Ghost of, Vec3 towards, double wavelength_nm = 550.0)
      : lens(std::move(state)), ghost(of), lambda_nm(wavelength_nm), direction(towards), light(towards),
        window(entrance_window(lens, light.source)), path(ghost_path(lens, ghost, lambda_nm)), tables(lens) {
    boxes = find_pupil(pupils::PupilRays(packets(), window), {.along_meridian = true}).boxes;
  }

  [[nodiscard]] PacketPath packets() const {
    return {path, tables.at(lambda_nm), {{0.0, 0.0, window.z_mm}, light.source}};
  }

  [[nodiscard]] ray_maps::LobattoRays ray_set(const Rectangle& box, int nodes, Rgb gain = {1, 1, 1}) const {
    ray_maps::LobattoTracer tracer(packets(), light);
    ray_maps::LobattoRays ray_set = tracer.trace(box, nodes, PacketPrecision::Double);
    ray_maps::add_light(ray_set, ray_set.transmission, gain);
    return ray_set;
  }

  // The ray through a point of the meridional entrance plane, traced in the lens's own coordinates.
  [[nodiscard]] RayRecord exact(Vec2 entrance_mm) const {
    const Vec2 p = light.to_lens_frame(entrance_mm);
    return trace_recorded(path, {{p.x, p.y, window.z_mm}, direction});
  }
};

}  // namespace contrejour::test
