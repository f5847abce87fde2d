// SPDX-License-Identifier: Apache-2.0
#include "render/bundle/map_figures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "optics/trace/packet_trace.h"

namespace contrejour::inline internal::bundle {
namespace {

constexpr double kVeryAnisotropic = 1000.0;
constexpr int kLowestLevel = 16;
constexpr int kHighestLevel = 512;
// The variance up to which the lowest level suffices; each further level admits ten times as much.
constexpr double kLowestVariance = 2e-4;
constexpr double kRoundPupil = std::numbers::pi / 4.0;
// The next level is used when the rays wanted on a side exceed this many times those of the present one.
constexpr double kNearEnough = 1.4;
// A cell with a ratio of width to length below this is a line.
constexpr double kThinnest = 1e-9;

class MapMeter {
 public:
  explicit MapMeter(const RayGrid& probe) : probe_(probe) {}

  [[nodiscard]] MapFigures measure() {
    for (int iy = 0; iy < probe_.cells(); ++iy) {
      for (int ix = 0; ix < probe_.cells(); ++ix) add_cell(probe_.corners(ix, iy));
    }
    for (std::size_t k = 0; k < probe_.blocked.size(); ++k) {
      // Weights a ray by its distance from the nearest edge: without a hard edge a coarse grid finds the centre
      // accurately.
      if (probe_.blocked[k] < 0.0F) add_ray(point(k), -static_cast<double>(probe_.blocked[k]) * probe_.transmission[k]);
    }
    finish();
    return figures_;
  }

 private:
  [[nodiscard]] Vec2 point(std::size_t k) const { return {probe_.sensor_x_mm[k], probe_.sensor_y_mm[k]}; }

  void add_cell(const std::array<std::size_t, 4>& v) {
    const auto blocked = [&](std::size_t k) { return probe_.blocked[k]; };
    if (std::none_of(v.begin(), v.end(), [&](std::size_t k) { return blocked(k) <= 0.0F; })) return;
    if (std::any_of(v.begin(), v.end(), [&](std::size_t k) { return blocked(k) == kFailed; })) return;
    const double area = 0.5 * cross(point(v[2]) - point(v[0]), point(v[3]) - point(v[1]));
    cells_ += 1.0;
    sum_ += area;
    sizes_ += std::abs(area);
    squares_ += area * area;
    figures_.anisotropy = std::max(figures_.anisotropy, stretch_ratio(v));
  }

  // The singular values of the cell's mean derivative follow from sigma1 sigma2 = |det|, sigma1^2 + sigma2^2 = trace.
  [[nodiscard]] double stretch_ratio(const std::array<std::size_t, 4>& v) const {
    const Vec2 step = probe_.step_mm();
    const Vec2 along_x = (point(v[1]) - point(v[0]) + point(v[2]) - point(v[3])) * (0.5 / step.x);
    const Vec2 along_y = (point(v[3]) - point(v[0]) + point(v[2]) - point(v[1])) * (0.5 / step.y);
    const double trace = dot(along_x, along_x) + dot(along_y, along_y);
    const double determinant = std::max(std::abs(cross(along_x, along_y)), kThinnest * trace);
    if (!(determinant > 0.0)) return 1.0;
    const double root = std::sqrt(std::max(0.0, 0.25 * trace * trace - determinant * determinant));
    return (0.5 * trace + root) / determinant;
  }

  void add_ray(Vec2 p, double weight) {
    figures_.weight += weight;
    moment_ = moment_ + p * weight;
    second_moment_ = second_moment_ + Vec2{p.x * p.x, p.y * p.y} * weight;
  }

  void finish() {
    const double all = static_cast<double>(probe_.cells()) * probe_.cells();
    figures_.open_fraction = cells_ / all;
    if (cells_ > 0.0 && sizes_ > 0.0) {
      const double mean = sum_ / cells_;
      const double size = sizes_ / cells_;
      figures_.area_variance = std::max(0.0, squares_ / cells_ - mean * mean) / (size * size);
    }
    if (!(figures_.weight > 0.0)) return;
    figures_.centre_mm = moment_ * (1.0 / figures_.weight);
    const Vec2 square = second_moment_ * (1.0 / figures_.weight);
    const Vec2 c = figures_.centre_mm;
    figures_.spread_mm = {std::sqrt(std::max(0.0, square.x - c.x * c.x)),
                          std::sqrt(std::max(0.0, square.y - c.y * c.y))};
  }

  const RayGrid& probe_;
  MapFigures figures_;
  double cells_ = 0, sum_ = 0, sizes_ = 0, squares_ = 0;
  Vec2 moment_, second_moment_;
};

}  // namespace

MapFigures measure_map(const RayGrid& probe) { return MapMeter(probe).measure(); }

int grid_level(const MapFigures& figures) {
  int side = kLowestLevel;
  for (double bound = kLowestVariance; side < kHighestLevel && figures.area_variance > bound; bound *= 10.0) side *= 2;
  // If no corner is open, the pupil is smaller than a cell of the probe.
  const double fraction = std::max(figures.open_fraction, 1.0 / (kProbeSide * kProbeSide));
  const double wanted = side * std::sqrt(kRoundPupil / fraction);
  while (side < kHighestLevel && side * kNearEnough < wanted) side *= 2;
  return side;
}

bool is_very_anisotropic(const MapFigures& figures) { return figures.anisotropy > kVeryAnisotropic; }

}  // namespace contrejour::inline internal::bundle
