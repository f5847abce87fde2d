#include "render/interface/direct_light.h"

#include <algorithm>
#include <cmath>

namespace contrejour {

LightSource measured_source(const LensState& lens, const Frame& frame, const LightSource& light) {
  const Vec2 uv = frame.uv_from_sensor(landing_of(lens, light, lens.design_wavelength_nm));
  const double outside = std::max(std::abs(uv.x - 0.5), std::abs(uv.y - 0.5)) / 0.5;
  if (!(outside > 1.0)) return light;
  const Vec2 edge = Vec2{0.5, 0.5} + (uv - Vec2{0.5, 0.5}) * (1.0 / outside);
  const Vec2 sensor_mm = frame.sensor_from_uv(edge);
  return {direction_to_land_at(lens, sensor_mm, lens.design_wavelength_nm, light.distance_mm), light.distance_mm};
}

Rgb direct_light(std::span<const SpectralBand> bands, std::span<const GhostMeter> meters,
                 std::span<const double> flux_mm2, double distance_mm) {
  const auto sum = [&](auto flux_of) {
    Rgb whole{};
    for (std::size_t k = 0; k < bands.size(); ++k) {
      const double flux = flux_of(k);
      for (std::size_t c = 0; c < whole.size(); ++c) whole[c] += bands[k].weight[c] * flux;
    }
    return whole;
  };
  const Rgb whole = sum([&](std::size_t k) { return flux_mm2[k]; });
  const LightSource on_axis({0.0, 0.0, 1.0}, distance_mm);
  return whole == Rgb{} ? sum([&](std::size_t k) { return meters[k].direct_flux(on_axis); }) : whole;
}

}  // namespace contrejour
