#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "contrejour/check_lens.h"
#include "contrejour/ghost.h"
#include "ghosts/direct_meter.h"
#include "ghosts/open_halves.h"
#include "ghosts/pupil_search.h"

namespace contrejour {
namespace {

constexpr int kGhostSide = 65;
constexpr double kFar = std::numeric_limits<double>::infinity();

void grow(Vec2& low, Vec2& high, Vec2 p) {
  low = {std::min(low.x, p.x), std::min(low.y, p.y)};
  high = {std::max(high.x, p.x), std::max(high.y, p.y)};
}

Vec2 sensor_point(const RayGrid& grid, std::size_t k) { return {grid.sensor_x_mm[k], grid.sensor_y_mm[k]}; }

GhostMeasure measured(const RayGrid& grid, double shared_flux) {
  GhostMeasure m;
  m.min_mm = {kFar, kFar};
  m.max_mm = {-kFar, -kFar};
  const auto add = [&](const OpenTriangle& t) {
    const double flux = t.flux_mm2 * shared_flux;
    m.flux_mm2 += flux;
    std::array<Vec2, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = sensor_point(grid, t.vertex[k]);
      m.centroid_mm = m.centroid_mm + p[k] * (flux / 3.0);
      grow(m.min_mm, m.max_mm, p[k]);
    }
    const double lit_mm2 = 0.5 * std::abs(cross(p[1] - p[0], p[2] - p[0])) * t.open;
    if (lit_mm2 > 0.0) m.peak_per_mm2 = std::max(m.peak_per_mm2, flux / lit_mm2);
  };
  for (int iy = 0; iy < grid.cells(); ++iy)
    for (int ix = 0; ix < grid.cells(); ++ix) for_each_open_half(grid, grid.corners(ix, iy), add);
  if (!(m.flux_mm2 > 0.0)) return {};
  m.centroid_mm = m.centroid_mm * (1.0 / m.flux_mm2);
  return m;
}

}  // namespace

GhostMeter::GhostMeter(LensState lens, double lambda_nm) : lens_(std::move(lens)) {
  if (check_lens(lens_) && is_wavelength(lambda_nm)) tables_ = std::make_unique<ReflectanceTables>(lens_, lambda_nm);
}
GhostMeter::~GhostMeter() = default;
GhostMeter::GhostMeter(GhostMeter&&) noexcept = default;
GhostMeter& GhostMeter::operator=(GhostMeter&&) noexcept = default;

double GhostMeter::direct_flux(const LightSource& light) const {
  if (!tables_ || !check_source(lens_, light)) return 0.0;
  return DirectMeter(lens_, light).flux_mm2(*tables_);
}

GhostMeasure GhostMeter::measure(Ghost ghost, const LightSource& light) const {
  if (!tables_ || !check_source(lens_, light) || !has_surfaces_of(lens_, ghost)) return {};
  const OpticalPath path = ghost_path(lens_, ghost, tables_->lambda_nm());
  const IrisShape iris(lens_.iris);
  const EntranceWindow window = entrance_window(lens_, light);
  RayGrid grid;
  const auto region = find_pupil_region(path, *tables_, iris, light, window, grid);
  if (!region) return {};
  grid.trace(path, *tables_, iris, light, window.z_mm, region->pupil_mm, kGhostSide, flux_precision(region->pupil_mm));
  return measured(grid, light.shared_flux());
}

}  // namespace contrejour
