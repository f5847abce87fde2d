// SPDX-License-Identifier: Apache-2.0
#include "c_interface/caller_lights.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "c_interface/objects.h"
#include "contrejour/expert/settings.h"
#include "contrejour/expert/spectrum_file.h"
#include "contrejour/expert/trace.h"

namespace contrejour {
inline namespace internal {
namespace {

double distance_of(double given_mm) { return given_mm == 0.0 ? std::numeric_limits<double>::infinity() : given_mm; }

Result<Light> light_of(const cj_light& given) {
  const Vec3 direction{given.direction[0], given.direction[1], given.direction[2]};
  if (!(length(direction) > 0.0) || !std::isfinite(length(direction)))
    return invalid_argument("a light's direction is zero or not finite; cj_direction_from_angles() makes one");
  Light light;
  light.direction = normalized(direction);
  light.value = {given.value[0], given.value[1], given.value[2]};
  light.distance_mm = distance_of(given.distance_mm);
  light.radius_rad = given.radius_rad;
  if (given.spectrum != nullptr) {
    auto spectrum = find_spectrum(given.spectrum);
    if (!spectrum) return tl::unexpected(spectrum.error());
    light.spectrum = std::move(*spectrum);
  }
  return light;
}

void store_direction(Vec3 direction, double to[3]) {
  to[0] = direction.x;
  to[1] = direction.y;
  to[2] = direction.z;
}

}  // namespace

Result<std::vector<Light>> lights_of(const cj_light* lights, std::size_t count) {
  std::vector<Light> all;
  if (count == 0) return all;
  if (const auto good = check_struct(lights, sizeof(cj_light), "cj_light"); !good) return tl::unexpected(good.error());
  const std::size_t step = lights->struct_size;
  const auto* const bytes = reinterpret_cast<const std::byte*>(lights);
  for (std::size_t k = 0; k < count; ++k) {
    cj_light given{};
    std::memcpy(&given, bytes + k * step, sizeof(cj_light));
    auto light = light_of(given);
    if (!light) return tl::unexpected(light.error());
    all.push_back(std::move(*light));
  }
  return all;
}

}  // namespace internal
}  // namespace contrejour

cj_status cj_direction_from_angles(double azimuth_rad, double elevation_rad, double direction[3], cj_error* error) {
  using namespace contrejour;
  return guarded(error, [&]() -> Result<void> {
    constexpr double kLargest_rad = 89.9 * params::kDegree_rad;  // beyond, no light meets the front of a lens
    if (const auto given = require(direction, "direction"); !given) return given;
    if (!(std::abs(azimuth_rad) <= kLargest_rad && std::abs(elevation_rad) <= kLargest_rad))
      return invalid_argument(
          fmt::format("a light at {}, {} radians is not in front of the camera; give angles of at "
                      "most 89.9 degrees",
                      azimuth_rad, elevation_rad));
    store_direction(direction_from_angles(azimuth_rad, elevation_rad), direction);
    return {};
  });
}

cj_status cj_direction_from_image(const cj_lens_state* state, const cj_settings* settings, double u, double v,
                                  double distance_mm, double direction[3], cj_error* error) {
  using namespace contrejour;
  return guarded(error, [&]() -> Result<void> {
    if (const auto given = require(state, "state"); !given) return given;
    if (const auto given = require(direction, "direction"); !given) return given;
    if (!std::isfinite(u) || !std::isfinite(v) || !(distance_mm >= 0.0))
      return invalid_argument(
          "u, v or the distance is not a number; give u and v of the picture, and a distance in mm");
    const params::Values values = values_of(settings);
    const Frame frame = params::whole_frame(values, state->state, *params::parse_size(*values.text("size")));
    store_direction(direction_for_image_point(state->state, frame.sensor_from_uv({u, v}),
                                              state->state.design_wavelength_nm, distance_of(distance_mm)),
                    direction);
    return {};
  });
}
