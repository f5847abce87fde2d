#include "ghosts/pupils/ghost_light.h"

#include <numeric>
#include <utility>

#include "ghosts/pupils/lit_mesh.h"

namespace contrejour::pupils {
namespace {

constexpr MeshDensity kFine{33, 120, 1e-4}, kRough{9, 12, 2e-2};

LightFrame frame_of(const PupilRequest& request) {
  return LightFrame(request.light, has_axial_symmetry(request.steps.lens(), request.ghost));
}

MeshTracer tracer_of(const PupilRequest& request, const LightFrame& light, const IrisShape& iris, double lambda_nm,
                     MeshDensity density) {
  if (iris.is_picture()) density.side = 2 * density.side - 1;  // for details smaller than blades
  const LightRays rays{{0.0, 0.0, request.window.z_mm}, light.source};
  return {PacketPath(request.steps.at(lambda_nm), request.ghost, rays, request.stop_times), light, iris, density};
}

double light_of(const std::vector<LitMesh>& meshes) {
  double light = 0.0;
  for (const LitMesh& mesh : meshes)
    light += std::inner_product(mesh.weight.begin(), mesh.weight.end(), mesh.transmission.begin(), 0.0);
  return light;
}

}  // namespace

Footprint footprint_of(const PupilRequest& request, const GhostPupil& pupil, double lambda_nm, const IrisShape& iris) {
  const LightFrame light = frame_of(request);
  MeshTracer tracer = tracer_of(request, light, iris, lambda_nm, kFine);
  return {tracer.trace(pupil.boxes), light.source.shared_flux()};
}

double rough_flux(const PupilRequest& request, const GhostPupil& pupil, double lambda_nm, const IrisShape& iris) {
  const LightFrame light = frame_of(request);
  return light_of(tracer_of(request, light, iris, lambda_nm, kRough).trace(pupil.boxes)) * light.source.shared_flux();
}

}  // namespace contrejour::pupils
