#include "render/interface/direct_light.h"

#include <algorithm>
#include <cmath>

namespace contrejour {

Vec3 measured_direction(const LensState& lens, const Frame& frame, Vec3 direction) {
  const Vec2 uv = frame.uv_from_sensor(landing_of(lens, direction, lens.design_wavelength_nm));
  const double outside = std::max(std::abs(uv.x - 0.5), std::abs(uv.y - 0.5)) / 0.5;
  if (!(outside > 1.0)) return direction;
  const Vec2 edge = Vec2{0.5, 0.5} + (uv - Vec2{0.5, 0.5}) * (1.0 / outside);
  return direction_to_land_at(lens, frame.sensor_from_uv(edge), lens.design_wavelength_nm);
}

Rgb direct_light(std::span<const SpectralBand> bands, std::span<const GhostMeter> meters,
                 std::span<const double> flux_mm2) {
  const auto sum = [&](auto flux_of) {
    Rgb whole{};
    for (std::size_t k = 0; k < bands.size(); ++k) {
      const double flux = flux_of(k);
      for (std::size_t c = 0; c < whole.size(); ++c) whole[c] += bands[k].weight[c] * flux;
    }
    return whole;
  };
  const Rgb whole = sum([&](std::size_t k) { return flux_mm2[k]; });
  return whole == Rgb{} ? sum([&](std::size_t k) { return meters[k].direct_flux({0.0, 0.0, 1.0}); }) : whole;
}

}  // namespace contrejour
