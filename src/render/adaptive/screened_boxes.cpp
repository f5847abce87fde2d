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

// Rays of a sheet, and what their light sees.
class ScreenedSheet {
 public:
  ScreenedSheet(const RaySheet& sheet, bool with_mirror_image, const BandScreen& screen, double unit,
                const LightFrame& light)
      : sheet_(sheet), mirror_image_(with_mirror_image), screen_(screen), unit_(unit), light_(light),
        flux_mm2_(light.source.shared_flux()), n_(static_cast<std::size_t>(sheet.nodes)),
        points_(lobatto_points(sheet.nodes)) {}

  // The cells' first rays.
  [[nodiscard]] bool has_cell(std::size_t first) const { return first % n_ != n_ - 1; }
  [[nodiscard]] std::array<std::size_t, 4> corners(std::size_t first) const {
    return {first, first + 1, first + n_ + 1, first + n_};
  }
  [[nodiscard]] bool arrives(std::size_t ray) const { return !std::isinf(sheet_.r_rel[ray]); }

  // The irradiance without a screen between four rays side by side.
  [[nodiscard]] double level(std::size_t first) const {
    std::array<Vec2, 4> sensor_mm;
    double transmission = 0.0;
    std::size_t c = 0;
    for (const std::size_t v : corners(first)) {
      sensor_mm[c++] = {sheet_.sensor_x_mm[v], sheet_.sensor_y_mm[v]};
      transmission = std::max(transmission, std::abs(static_cast<double>(sheet_.transmission[v])));
    }
    const auto step = [&](std::size_t k) { return 0.5 * (points_[k + 1] - points_[k]); };
    const Vec2 size = sheet_.box.high - sheet_.box.low;
    const double entrance_mm2 = size.x * step(first % n_) * size.y * step(first / n_);
    const double image_mm2 = 0.5 * std::abs(cross(sensor_mm[2] - sensor_mm[0], sensor_mm[3] - sensor_mm[1]));
    return transmission * flux_mm2_ * entrance_mm2 / std::max(image_mm2, kFolded_mm2);
  }
  // About how wide it is in the stop.
  [[nodiscard]] double radius(std::size_t first) const {
    const Vec2 middle = middle_of(first, 1.0);
    double radius = 0.0;
    for (const std::size_t v : corners(first)) radius = std::max(radius, length(stop(v, 1.0) - middle));
    return kScreenDisc * radius;
  }
  // The largest share that passes to it, or within `radius` of a ray.
  [[nodiscard]] double passed(std::size_t first) const {
    const double about = radius(first);
    double most = screen_.over(middle_of(first, 1.0), about).most;
    if (mirror_image_) most = std::max(most, screen_.over(middle_of(first, -1.0), about).most);
    return most;
  }
  [[nodiscard]] double passed_about(std::size_t ray, double radius) const {
    double most = screen_.over(stop(ray, 1.0), radius).most;
    if (mirror_image_) most = std::max(most, screen_.over(stop(ray, -1.0), radius).most);
    return most;
  }

 private:
  // turned: -1 in the mirror image.
  [[nodiscard]] Vec2 stop(std::size_t v, double turned) const {
    return light_.into_place({sheet_.stop.back()[0][v], turned * sheet_.stop.back()[1][v]}) * unit_;
  }
  [[nodiscard]] Vec2 middle_of(std::size_t first, double turned) const {
    Vec2 sum{};
    for (const std::size_t v : corners(first)) sum = sum + stop(v, turned) * 0.25;
    return sum;
  }

  const RaySheet& sheet_;
  bool mirror_image_;
  const BandScreen& screen_;
  double unit_;
  const LightFrame& light_;
  double flux_mm2_;
  std::size_t n_;
  const std::vector<double>& points_;
};

}  // namespace

std::optional<double> brightest_passed(const RaySheet& sheet, bool with_mirror_image, const BandScreen& screen,
                                       double unit, const LightFrame& light, double enough) {
  if (sheet.stop.empty()) return std::nullopt;
  const ScreenedSheet cells(sheet, with_mirror_image, screen, unit, light);
  const std::size_t count = sheet.count() - static_cast<std::size_t>(sheet.nodes) - 1;
  std::vector<std::size_t> broken;  // cells with rays that fail
  double level = 0.0, radius = 0.0; // of any that is whole
  std::optional<double> brightest;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t first = (k + count / 2) % count;  // what is in the middle is most likely bright
    if (!cells.has_cell(first)) continue;
    const auto rays = cells.corners(first);
    if (!std::all_of(rays.begin(), rays.end(), [&](std::size_t v) { return cells.arrives(v); })) {
      broken.push_back(first);
      continue;
    }
    const double here = cells.level(first);
    level = std::max(level, here);
    radius = std::max(radius, cells.radius(first));
    if (here > brightest.value_or(-1.0)) brightest = std::max(brightest.value_or(0.0), cells.passed(first) * here);
    if (*brightest > enough) return brightest;
  }
  for (std::size_t k = 0; brightest && level > *brightest && k < broken.size(); ++k)
    for (const std::size_t v : cells.corners(broken[k]))
      if (cells.arrives(v)) brightest = std::max(*brightest, cells.passed_about(v, 2.0 * radius) * level);
  return brightest;
}

}  // namespace contrejour::adaptive
