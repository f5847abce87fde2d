#include <algorithm>
#include <cmath>
#include <limits>

#include "contrejour/ghost.h"
#include "ghosts/pupil_region.h"

namespace contrejour {
namespace {

constexpr int kFluxCells = 96;     // a side: the direct flux is good to 3e-4
constexpr int kGhostCells = 64;    // a side: fluxes for ranking and tables, 1e-3
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double mean_transmission(const PupilTriangle& t) {
  return (t.ray[0]->transmission + t.ray[1]->transmission + t.ray[2]->transmission) / 3.0;
}

double sensor_area(const PupilTriangle& t) {
  return 0.5 * std::abs(cross(t.ray[1]->sensor_mm - t.ray[0]->sensor_mm, t.ray[2]->sensor_mm - t.ray[0]->sensor_mm));
}

void grow(Vec2& low, Vec2& high, Vec2 p) {
  low = {std::min(low.x, p.x), std::min(low.y, p.y)};
  high = {std::max(high.x, p.x), std::max(high.y, p.y)};
}

}  // namespace

double direct_flux(const LensState& lens, Vec3 direction, double lambda_nm) {
  const OpticalPath path = direct_path(lens, lambda_nm);
  const EntranceWindow window = entrance_window(lens, direction);
  const auto box = find_pupil(path, lens.iris, direction, window);
  if (!box) return 0.0;
  double flux = 0.0;
  for_each_open_triangle(path, lens.iris, direction, window.z_mm, *box, kFluxCells, [&](const PupilTriangle& t) {
    flux += mean_transmission(t) * t.area_mm2 * t.open_fraction;
  });
  return flux * direction.z;
}

GhostMeasure measure_ghost(const LensState& lens, Ghost ghost, Vec3 direction, double lambda_nm) {
  const OpticalPath path = ghost_path(lens, ghost, lambda_nm);
  const EntranceWindow window = entrance_window(lens, direction);
  GhostMeasure m;
  const auto box = find_pupil(path, lens.iris, direction, window);
  if (!box) return m;
  m.min_mm = m.pupil_min_mm = {kInfinity, kInfinity};
  m.max_mm = m.pupil_max_mm = {-kInfinity, -kInfinity};
  for_each_open_triangle(path, lens.iris, direction, window.z_mm, *box, kGhostCells, [&](const PupilTriangle& t) {
    const double flux = mean_transmission(t) * t.area_mm2 * t.open_fraction * direction.z;
    m.flux_mm2 += flux;
    for (int k = 0; k < 3; ++k) {
      m.centroid_mm = m.centroid_mm + t.ray[k]->sensor_mm * (flux / 3.0);
      grow(m.min_mm, m.max_mm, t.ray[k]->sensor_mm);
      grow(m.pupil_min_mm, m.pupil_max_mm, t.point_mm[k]);
    }
    const double lit = sensor_area(t) * t.open_fraction;
    if (lit > 0.0) m.peak_per_mm2 = std::max(m.peak_per_mm2, flux / lit);
  });
  if (m.flux_mm2 > 0.0) {
    m.centroid_mm = m.centroid_mm * (1.0 / m.flux_mm2);
  } else {
    m = {};
  }
  return m;
}

}  // namespace contrejour
