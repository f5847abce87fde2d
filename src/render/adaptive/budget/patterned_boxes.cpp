// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive/budget/patterned_boxes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "render/ray_maps/lobatto_cells.h"

namespace contrejour::inline internal::adaptive {
namespace {

constexpr double kPatternDisc = 1.2;    // radius of a curved cell over that of its corners, in the stop
constexpr double kFolded_mm2 = 1e-12;  // area below which a cell's image counts as folded

// The rays of a ray set, and the parts of the stop pattern that their light crosses.
class PatternedRays {
 public:
  PatternedRays(const LobattoRays& ray_set, bool with_mirror_image, const stop_patterns::BandStopPattern& screen,
                double unit, const LightFrame& light)
      : ray_set_(ray_set), mirror_image_(with_mirror_image), pattern_(screen), unit_(unit), light_(light),
        flux_mm2_(light.source.shared_flux()), cells_(ray_set) {}

  [[nodiscard]] const LobattoCells& cells() const { return cells_; }
  [[nodiscard]] bool arrives(std::size_t ray) const { return !std::isinf(ray_set_.relative_height[ray]); }

  // The irradiance between four neighbouring rays, without the stop pattern.
  [[nodiscard]] double level(std::size_t first) const {
    double transmission = 0.0;
    for (const std::size_t v : cells_.corners(first))
      transmission = std::max(transmission, std::abs(static_cast<double>(ray_set_.transmission[v])));
    return transmission * flux_mm2_ * cells_.entrance_mm2(first) / std::max(cells_.image_mm2(first), kFolded_mm2);
  }
  // About the radius of the cell in the stop.
  [[nodiscard]] double radius(std::size_t first) const {
    const Vec2 middle = middle_of(first, 1.0);
    double radius = 0.0;
    for (const std::size_t v : cells_.corners(first)) radius = std::max(radius, length(stop(v, 1.0) - middle));
    return kPatternDisc * radius;
  }
  // The pattern's largest transmittance for the cell, or within `radius` of a ray.
  [[nodiscard]] double transmitted(std::size_t first) const {
    const double about = radius(first);
    double largest = pattern_.over(middle_of(first, 1.0), about).max_transmittance;
    if (mirror_image_) largest = std::max(largest, pattern_.over(middle_of(first, -1.0), about).max_transmittance);
    return largest;
  }
  [[nodiscard]] double transmitted_about(std::size_t ray, double radius) const {
    double largest = pattern_.over(stop(ray, 1.0), radius).max_transmittance;
    if (mirror_image_) largest = std::max(largest, pattern_.over(stop(ray, -1.0), radius).max_transmittance);
    return largest;
  }

 private:
  // side: -1 for the mirror image.
  [[nodiscard]] Vec2 stop(std::size_t v, double side) const {
    return light_.to_lens_frame({ray_set_.stop.back()[0][v], side * ray_set_.stop.back()[1][v]}) * unit_;
  }
  [[nodiscard]] Vec2 middle_of(std::size_t first, double side) const {
    Vec2 sum{};
    for (const std::size_t v : cells_.corners(first)) sum = sum + stop(v, side) * 0.25;
    return sum;
  }

  const LobattoRays& ray_set_;
  bool mirror_image_;
  const stop_patterns::BandStopPattern& pattern_;
  double unit_;
  const LightFrame& light_;
  double flux_mm2_;
  LobattoCells cells_;
};

}  // namespace

std::optional<double> brightest_transmitted(const LobattoRays& ray_set, bool with_mirror_image,
                                            const stop_patterns::BandStopPattern& screen, double unit,
                                            const LightFrame& light, double enough) {
  if (ray_set.stop.empty()) return std::nullopt;
  const PatternedRays screened(ray_set, with_mirror_image, screen, unit, light);
  const LobattoCells& cells = screened.cells();
  const std::size_t count = cells.end();
  std::vector<std::size_t> broken;  // cells with rays that fail
  double level = 0.0, radius = 0.0; // largest of all cells whose rays all arrive
  std::optional<double> brightest;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t first = (k + count / 2) % count;  // start in the middle, which is most likely bright
    if (!cells.has(first)) continue;
    const auto rays = cells.corners(first);
    if (!std::all_of(rays.begin(), rays.end(), [&](std::size_t v) { return screened.arrives(v); })) {
      broken.push_back(first);
      continue;
    }
    const double here = screened.level(first);
    level = std::max(level, here);
    radius = std::max(radius, screened.radius(first));
    if (here > brightest.value_or(-1.0))
      brightest = std::max(brightest.value_or(0.0), screened.transmitted(first) * here);
    if (*brightest > enough) return brightest;
  }
  for (std::size_t k = 0; brightest && level > *brightest && k < broken.size(); ++k)
    for (const std::size_t v : cells.corners(broken[k]))
      if (screened.arrives(v)) brightest = std::max(*brightest, screened.transmitted_about(v, 2.0 * radius) * level);
  return brightest;
}

}  // namespace contrejour::inline internal::adaptive
