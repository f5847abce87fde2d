// SPDX-License-Identifier: Apache-2.0
// A ghost's footprint, accumulated mesh by mesh: its flux, centroid, bounds and peak.
#pragma once

#include <vector>

#include "contrejour/expert/ghost.h"
#include "render/pupils/open_mesh.h"

namespace contrejour::inline internal::pupils {

class Footprint {
 public:
  // shared_flux: LightSource's.
  Footprint(std::vector<OpenMesh> meshes, double shared_flux);

  // All figures but the peak.
  [[nodiscard]] const GhostMeasure& measure() const { return measure_; }
  [[nodiscard]] const std::vector<OpenMesh>& meshes() const { return meshes_; }
  // The flux that lands inside a rectangle of the sensor.
  [[nodiscard]] double flux_within_mm2(const Rectangle& sensor_mm) const;
  // The mean over the brightest square of side pixel_mm; 0: over the brightest cell.
  [[nodiscard]] double peak_per_mm2(double pixel_mm) const;

 private:
  void add(const OpenMesh& mesh);
  void grow(Vec2 sensor_point_mm);

  std::vector<OpenMesh> meshes_;
  double shared_flux_;
  GhostMeasure measure_;
};

}  // namespace contrejour::inline internal::pupils
