// SPDX-License-Identifier: Apache-2.0
#include "render/pupils/ghost_light.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "render/pupils/open_mesh.h"

namespace contrejour::inline internal::pupils {
namespace {

constexpr MeshDensity kFineMesh{33, 120, 1e-4}, kCoarseMesh{9, 12, 2e-2};

LightFrame frame_of(const PupilRequest& request) {
  return LightFrame(request.light, has_axial_symmetry(request.steps.lens(), request.ghost));
}

MeshTracer tracer_of(const PupilRequest& request, const LightFrame& light, const IrisShape& iris, double lambda_nm,
                     MeshDensity density) {
  if (iris.is_picture()) density.side = 2 * density.side - 1;  // for details smaller than blades
  const LightRays rays{{0.0, 0.0, request.window.z_mm}, light.source};
  return {PacketPath(request.steps.at(lambda_nm), request.ghost, rays, request.stop_times), light, iris, density};
}

// Sample points of the open part of the entrance plane.
struct PupilSamples {
  Vec2 origin_mm;
  std::vector<float> x_mm, y_mm;     // from there
  std::vector<double> weight;        // the open area that each represents, up to a common factor
  double light = 0.0;                // weights times transmissions, summed
  double spacing_mm = 0.0;             // smallest distance of neighbouring rays
};

// Adds vertices of a mesh as samples, one for each equal step of open area, block by block, so that samples cover the
// whole mesh. sum_mm2: the open area of the preceding meshes.
void add_samples(const OpenMesh& mesh, double step_mm2, double& sum_mm2, PupilSamples& samples) {
  std::vector<bool> visited(mesh.weight.size(), false);
  const Vec2 origin = mesh.origin_mm - samples.origin_mm;
  for (const Block& block : mesh.blocks) {
    for (std::size_t k = 0; k < block.vertex.size(); ++k) {
      const std::size_t vertex = block.vertex[k];
      if (visited[vertex]) continue;
      visited[vertex] = true;
      const double before = std::round(sum_mm2 / step_mm2);
      sum_mm2 += std::max(mesh.weight[vertex], 0.0);
      const double steps = std::round(sum_mm2 / step_mm2) - before;
      if (!(steps > 0.0)) continue;
      const Vec2 point = origin + block.low_mm;
      samples.x_mm.push_back(static_cast<float>(point.x + static_cast<double>(k % 3) * mesh.step_mm.x));
      samples.y_mm.push_back(static_cast<float>(point.y + static_cast<double>(k / 3) * mesh.step_mm.y));
      samples.weight.push_back(steps);
      samples.light += steps * mesh.transmission[vertex];
    }
  }
}

// The samples of all meshes together.
PupilSamples samples_of(const std::vector<OpenMesh>& meshes) {
  constexpr int kSamples = 32;
  PupilSamples samples;
  samples.origin_mm = meshes.front().origin_mm;
  samples.spacing_mm = meshes.front().step_mm.x;
  double open_mm2 = 0.0;
  for (const OpenMesh& mesh : meshes) {
    samples.spacing_mm = std::min({samples.spacing_mm, mesh.step_mm.x, mesh.step_mm.y});
    for (const double weight : mesh.weight) open_mm2 += std::max(weight, 0.0);
  }
  double sum_mm2 = 0.0;
  for (const OpenMesh& mesh : meshes) add_samples(mesh, open_mm2 / kSamples, sum_mm2, samples);
  return samples;
}

// The ratio of the flux at another wavelength to that of the samples.
double ratio_at(const PupilRequest& request, const LightFrame& light, const IrisShape& iris, double lambda_nm,
                const PupilSamples& samples, RayGrid& rays) {
  const LightRays from{{0.0, 0.0, request.window.z_mm}, light.source};
  PacketPath path(request.steps.at(lambda_nm), request.ghost, from, request.stop_times);
  rays.trace_points(path, iris, light, samples.origin_mm, samples.x_mm, samples.y_mm,
                    search_precision(samples.spacing_mm));
  double sum = 0.0;
  for (std::size_t k = 0; k < samples.weight.size(); ++k)
    if (std::isfinite(rays.blocked[k])) sum += samples.weight[k] * rays.transmission[k];
  return sum / samples.light;
}

}  // namespace

Footprint footprint_of(const PupilRequest& request, const GhostPupil& pupil, double lambda_nm, const IrisShape& iris) {
  const LightFrame light = frame_of(request);
  MeshTracer tracer = tracer_of(request, light, iris, lambda_nm, kFineMesh);
  return {tracer.trace(pupil.boxes), light.source.shared_flux()};
}

std::vector<double> approximate_fluxes_within(const PupilRequest& request, const GhostPupil& searched,
                                              std::span<const double> lambda_nm, const IrisShape& iris,
                                              const Rectangle& sensor_mm) {
  std::vector<double> fluxes(lambda_nm.size(), 0.0);
  if (searched.boxes.empty()) return fluxes;
  const std::vector<Rectangle> boxes = disjoint(searched.boxes);
  const LightFrame light = frame_of(request);
  const auto footprint_at = [&](double nm) {
    return Footprint(tracer_of(request, light, iris, nm, kCoarseMesh).trace(boxes), light.source.shared_flux());
  };
  const double middle_nm = middle_wavelength(request);
  const Footprint middle = footprint_at(middle_nm);
  const double middle_flux = middle.flux_within_mm2(sensor_mm);
  const bool is_dark = !(middle.measure().flux_mm2 > 0.0);  // as coatings can make it at one wavelength
  if (!is_dark && !(middle_flux > 0.0)) return fluxes;
  const PupilSamples samples = is_dark ? PupilSamples{} : samples_of(middle.meshes());
  RayGrid rays;
  for (std::size_t k = 0; k < lambda_nm.size(); ++k) {
    const double nm = lambda_nm[k];
    fluxes[k] = nm == middle_nm       ? middle_flux
                : samples.light > 0.0 ? middle_flux * ratio_at(request, light, iris, nm, samples, rays)
                                      : footprint_at(nm).flux_within_mm2(sensor_mm);
  }
  return fluxes;
}

}  // namespace contrejour::inline internal::pupils
