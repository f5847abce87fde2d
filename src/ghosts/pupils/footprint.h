// Where a ghost's light lands, added up mesh by mesh: its flux, middle, bounds and brightest place.
#pragma once

#include <vector>

#include "contrejour/ghost.h"
#include "ghosts/pupils/open_mesh.h"

namespace contrejour::pupils {

class Footprint {
 public:
  // shared_flux: LightSource's. pixel_mm: side of the square that the peak is the mean over; 0: none is taken.
  Footprint(double shared_flux, double pixel_mm)
      : shared_flux_(shared_flux), pixel_mm_(pixel_mm >= kLeast_mm && pixel_mm <= kMost_mm ? pixel_mm : 0.0) {}

  void add(const OpenMesh& mesh);
  [[nodiscard]] GhostMeasure measure() const;

 private:
  static constexpr double kLeast_mm = 1e-9, kMost_mm = 1e9;  // of a square

  struct Part {
    OpenMesh mesh;
    std::vector<OpenCell> cells;
  };

  void grow(Vec2 landing_mm);
  void add_bounds(const OpenMesh& mesh, const OpenCell& cell);
  [[nodiscard]] std::vector<Vec2> bright_places() const;
  [[nodiscard]] double mean_about(Vec2 place) const;
  [[nodiscard]] double peak_per_mm2() const;

  double shared_flux_, pixel_mm_;
  GhostMeasure sum_;  // centroid times flux
  std::vector<Part> parts_;
};

}  // namespace contrejour::pupils
