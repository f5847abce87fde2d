#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "contrejour/ghost.h"
#include "ghosts/pupil_search.h"

namespace contrejour {
namespace {

// The direct image's pupil: rays a side of the grid that is summed, and of those traced, cubics making the rest.
// Few where the iris alone bounds the pupil; more where rims do, whose edges meet in corners; all where rays fail.
constexpr int kDirectSide = 97;
constexpr int kDirectSmooth = 6;  // so many times fewer
constexpr int kDirectRims = 2;
constexpr int kDirectPicture = 4;  // so many times as many for a picture's details
constexpr int kDirectSearchSide = 17;
constexpr float kNearRim = 0.1F;  // of the clear height; of the stop radius
constexpr int kGhostSide = 65;
constexpr double kFloatPupil_mm = 1.0;
constexpr float kFailed = std::numeric_limits<float>::infinity();
constexpr double kFar = std::numeric_limits<double>::infinity();

// Share of a triangle where a function that is linear over it is <= 0.
double share_below_zero(double a, double b, double c) {
  if (a > b) std::swap(a, b);
  if (b > c) std::swap(b, c);
  if (a > b) std::swap(a, b);
  if (c <= 0.0) return 1.0;
  if (a > 0.0) return 0.0;
  if (b > 0.0) return a / (a - b) * (a / (a - c));  // the corner at a
  return 1.0 - c / (c - a) * (c / (c - b));         // all but the corner at c
}

// Half a cell of the grid: its vertices, the share of it that is open, and the flux through that share.
struct OpenTriangle {
  std::array<std::size_t, 3> vertex;
  double open = 0;
  double flux_mm2 = 0;  // but for what all points share (LightSource)
};

// Of a cell, by its vertices in turn.
template <class Visit>
void for_each_open_half(const RayGrid& grid, const std::array<std::size_t, 4>& q, const Visit& visit) {
  const Vec2 step = grid.step_mm();
  for (const auto& v : {std::array{q[0], q[1], q[2]}, std::array{q[0], q[2], q[3]}}) {
    const auto blocked = [&](std::size_t k) { return grid.blocked[v[k]]; };
    if (!(blocked(0) < kFailed && blocked(1) < kFailed && blocked(2) < kFailed)) continue;
    const double open = share_below_zero(blocked(0), blocked(1), blocked(2));
    if (open <= 0.0) continue;
    const double transmission = (grid.transmission[v[0]] + grid.transmission[v[1]] + grid.transmission[v[2]]) / 3.0;
    visit(OpenTriangle{v, open, open * transmission * 0.5 * step.x * step.y});
  }
}

// Through all of the grid, but for what all points share; most cells are open or closed as a whole.
double open_flux(const RayGrid& grid) {
  const Vec2 step = grid.step_mm();
  double flux = 0.0, whole = 0.0;  // whole: six times their mean transmissions
  for (int iy = 0; iy < grid.cells(); ++iy) {
    const float* const blocked[2]{&grid.blocked[grid.at(0, iy)], &grid.blocked[grid.at(0, iy + 1)]};
    const float* const light[2]{&grid.transmission[grid.at(0, iy)], &grid.transmission[grid.at(0, iy + 1)]};
    for (int ix = 0; ix < grid.cells(); ++ix) {
      const float a = blocked[0][ix], b = blocked[0][ix + 1], c = blocked[1][ix + 1], d = blocked[1][ix];
      if (std::min(std::min(a, b), std::min(c, d)) > 0.0F) continue;
      if (std::max(std::max(a, b), std::max(c, d)) <= 0.0F)
        whole += 2.0F * (light[0][ix] + light[1][ix + 1]) + light[0][ix + 1] + light[1][ix];
      else
        for_each_open_half(grid, grid.corners(ix, iy), [&](const OpenTriangle& t) { flux += t.flux_mm2; });
    }
  }
  return flux + whole * step.x * step.y / 6.0;
}

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

// Where rays of one path from one direction get through, and how to trace them there.
struct Pupil {
  const OpticalPath& path;
  const ReflectanceTables& tables;
  const IrisShape& iris;
  const LightSource& light;
  double z_mm;
  Rectangle box;

  // Fluxes need shares of cells, not places on the sensor: float will do unless the pupil is tiny.
  void trace(RayGrid& grid, int side) const {
    const Vec2 size = box.high - box.low;
    const bool wide = std::min(size.x, size.y) > kFloatPupil_mm;
    grid.trace(path, tables, iris, light, z_mm, box, side, wide ? PacketPrecision::Float : PacketPrecision::Double);
  }
};

bool all_arrived(const RayGrid& grid) {
  return std::all_of(grid.blocked.begin(), grid.blocked.end(), [](float blocked) { return blocked < kFailed; });
}

// Whether a rim comes near what the iris lets through.
bool is_cut_by_rims(const RayGrid& grid) {
  for (std::size_t k = 0; k < grid.r_rel.size(); ++k) {
    float iris = -kFailed;
    for (std::size_t c = 0; c < static_cast<std::size_t>(grid.stop_crossings()); ++c)
      iris = std::max(iris, grid.iris_distance[c][k]);
    if (iris < kNearRim && grid.r_rel[k] > 1.0F - kNearRim) return true;
  }
  return false;
}

// A grid of kDirectSide rays a side over the pupil, but for rounding of cubics.
void trace_direct(const Pupil& pupil, RayGrid& grid) {
  const auto try_with = [&](int refinement) {
    pupil.trace(grid, (kDirectSide - 1) / refinement + 1);
    return all_arrived(grid);
  };
  const int details = pupil.iris.is_picture() ? kDirectPicture : 1;
  if (!pupil.path.obscured && try_with(kDirectSmooth) && !is_cut_by_rims(grid))
    return grid.refine(pupil.iris, kDirectSmooth * details);
  if (!pupil.path.obscured && try_with(kDirectRims)) return grid.refine(pupil.iris, kDirectRims * details);
  pupil.trace(grid, (kDirectSide - 1) * details + 1);
}

}  // namespace

GhostMeter::GhostMeter(LensState lens, double lambda_nm)
    : lens_(std::make_shared<const LensState>(std::move(lens))), lambda_nm_(lambda_nm),
      tables_(std::make_shared<ReflectanceTables>(*lens_, lambda_nm)) {}
GhostMeter::GhostMeter(std::shared_ptr<const LensState> lens, std::shared_ptr<const ReflectanceTables> tables)
    : lens_(std::move(lens)), lambda_nm_(tables->lambda_nm()), tables_(std::move(tables)) {}
GhostMeter::~GhostMeter() = default;
GhostMeter::GhostMeter(GhostMeter&&) noexcept = default;
GhostMeter& GhostMeter::operator=(GhostMeter&&) noexcept = default;

double GhostMeter::direct_flux(const LightSource& light) const {
  const OpticalPath path = direct_path(*lens_, lambda_nm_);
  const IrisShape iris(lens_->iris);
  const EntranceWindow window = entrance_window(*lens_, light);
  RayGrid grid;
  const auto region =
      find_pupil_region(path, *tables_, iris, light, window, grid, PupilEffort::Finest, kDirectSearchSide);
  if (!region) return 0.0;
  trace_direct({path, *tables_, iris, light, window.z_mm, region->pupil_mm}, grid);
  return open_flux(grid) * light.shared_flux();
}

GhostMeasure GhostMeter::measure(Ghost ghost, const LightSource& light) const {
  const OpticalPath path = ghost_path(*lens_, ghost, lambda_nm_);
  const IrisShape iris(lens_->iris);
  const EntranceWindow window = entrance_window(*lens_, light);
  RayGrid grid;
  const auto region = find_pupil_region(path, *tables_, iris, light, window, grid);
  if (!region) return {};
  Pupil{path, *tables_, iris, light, window.z_mm, region->pupil_mm}.trace(grid, kGhostSide);
  return measured(grid, light.shared_flux());
}

}  // namespace contrejour
