#include "render/adaptive/screened_boxes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "render/adaptive/lobatto.h"

namespace contrejour::adaptive {
namespace {

constexpr double kScreenDisc = 1.2;    // of a cell's distance from its middle in the stop, for cells that bend
constexpr double kFolded_mm2 = 1e-12;  // of a cell's image

// What lies between four rays side by side that arrive.
struct RayCell {
  Vec2 stop;            // stop radii
  double radius = 0.0;  // about that, likewise
  double level = 0.0;   // the irradiance without a screen
};

// Of the rays from `first` on; none if one of them fails.
std::optional<RayCell> cell_at(const RaySheet& sheet, std::size_t first, double unit, const LightFrame& light) {
  const auto n = static_cast<std::size_t>(sheet.nodes);
  const std::array corner{first, first + 1, first + n + 1, first + n};
  if (std::any_of(corner.begin(), corner.end(), [&](std::size_t v) { return std::isinf(sheet.r_rel[v]); })) return {};
  std::array<Vec2, 4> sensor_mm, at;
  double transmission = 0.0;
  RayCell cell;
  for (std::size_t c = 0; c < corner.size(); ++c) {
    const std::size_t v = corner[c];
    sensor_mm[c] = {sheet.sensor_x_mm[v], sheet.sensor_y_mm[v]};
    at[c] = light.into_place({sheet.stop.back()[0][v], sheet.stop.back()[1][v]}) * unit;
    cell.stop = cell.stop + at[c] * 0.25;
    transmission = std::max(transmission, std::abs(static_cast<double>(sheet.transmission[v])));
  }
  for (const Vec2 p : at) cell.radius = std::max(cell.radius, kScreenDisc * length(p - cell.stop));
  const auto points = lobatto_points(sheet.nodes);
  const auto step = [&](std::size_t k) { return 0.5 * (points[k + 1] - points[k]); };
  const Vec2 size = sheet.box.high - sheet.box.low;
  const double entrance_mm2 = size.x * step(first % n) * size.y * step(first / n);
  const double image_mm2 = 0.5 * std::abs(cross(sensor_mm[2] - sensor_mm[0], sensor_mm[3] - sensor_mm[1]));
  cell.level = transmission * light.source.shared_flux() * entrance_mm2 / std::max(image_mm2, kFolded_mm2);
  return cell;
}

}  // namespace

std::optional<double> brightest_passed(const RaySheet& sheet, const BandScreen& screen, double unit,
                                       const LightFrame& light) {
  if (sheet.stop.empty()) return std::nullopt;
  const auto n = static_cast<std::size_t>(sheet.nodes);
  std::vector<std::size_t> broken;  // cells with rays that fail
  RayCell any;                      // as wide and bright as any that is whole
  std::optional<double> brightest;
  for (std::size_t first = 0; first + n + 1 < sheet.count(); ++first) {
    if (first % n == n - 1) continue;
    const auto cell = cell_at(sheet, first, unit, light);
    if (!cell) {
      broken.push_back(first);
      continue;
    }
    any.radius = std::max(any.radius, cell->radius);
    any.level = std::max(any.level, cell->level);
    brightest = std::max(brightest.value_or(0.0), screen.over(cell->stop, cell->radius).most * cell->level);
  }
  for (std::size_t k = 0; brightest && k < broken.size(); ++k) {
    for (const std::size_t v : {broken[k], broken[k] + 1, broken[k] + n, broken[k] + n + 1}) {
      if (std::isinf(sheet.r_rel[v])) continue;
      const Vec2 at = light.into_place({sheet.stop.back()[0][v], sheet.stop.back()[1][v]}) * unit;
      brightest = std::max(*brightest, screen.over(at, 2.0 * any.radius).most * any.level);
    }
  }
  return brightest;
}

}  // namespace contrejour::adaptive
