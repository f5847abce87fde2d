// SPDX-License-Identifier: Apache-2.0
#include "settings/photometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "contrejour/expert/direct_image.h"
#include "contrejour/expert/first_order.h"
#include "contrejour/expert/ghost.h"

namespace contrejour::params {
namespace {

constexpr double kMiddleGrey = 0.18;
constexpr double kGreyExposure_lx_s = 10.0;  // at ISO 1; ISO 12232:2019, standard output sensitivity
constexpr double kWhiteExposure_lx_s = kGreyExposure_lx_s / kMiddleGrey;
constexpr double kMm_per_m = 1000.0;

// The area in mm^2 of the plane before the lens through which the light of its direct image enters. If no light reaches
// the frame's edge, the area is that on the axis.
double entrance_area_mm2(const LensState& lens, const Frame& frame, const LightSource& source) {
  const GhostMeter meter(lens, lens.design_wavelength_nm);
  const double own_mm2 = meter.direct_flux(measured_source(lens, frame, source));
  return own_mm2 > 0.0 ? own_mm2 : meter.direct_flux(LightSource({0.0, 0.0, 1.0}, source.distance_mm));
}

// The value of a light that gives this illuminance at the lens: E A / a lux on a pixel of area a, during the exposure's
// time.
double sum_of_lux(double lux, const Light& light, const LensState& lens, const Frame& frame, const Exposure& exposure) {
  const double pixel_mm2 = frame.pixel_pitch_mm * frame.pixel_pitch_mm;
  const double on_pixels_lux = lux * entrance_area_mm2(lens, frame, light.source()) / pixel_mm2;
  return on_pixels_lux * exposure.shutter_s * exposure.iso / kWhiteExposure_lx_s;
}

// The number of pixels of a disc on the axis.
double pixels_of_disc(double radius_rad, const LensState& lens, const Frame& frame) {
  const double radius = std::tan(radius_rad) / frame.pixel_pitch_mm;
  const FirstOrder figures = first_order(lens, lens.design_wavelength_nm);
  return std::numbers::pi * radius * radius * std::abs(figures.focal_length_mm * figures.focal_length_x_mm);
}

}  // namespace

Result<double> sum_of(const LightValue& value, const Light& light, const LensState& lens, const Frame& frame,
                      const Exposure& exposure) {
  using Unit = LightValue::Unit;
  const double amount = value.rgb[0];
  const bool has_size = light.radius_rad > 0.0;
  if (lens.surfaces.empty() && value.unit != Unit::Sum)
    return invalid_argument(
        "a measured flare does not say how much light its lens lets in; give the value of a light as the sum of its "
        "direct image, a number without a unit");
  switch (value.unit) {
    case Unit::Sum: return amount;
    case Unit::Stops:
      if (!has_size)
        return invalid_argument(
            "a point has no stops above white; give the light a diameter with --light-size, or another unit");
      return std::exp2(amount) * pixels_of_disc(light.radius_rad, lens, frame);
    case Unit::Nits: {
      if (!has_size)
        return invalid_argument(
            "a point has no luminance in nits; give the light a diameter with --light-size, or its illuminance in lx");
      const double sine = std::sin(light.radius_rad);
      return sum_of_lux(amount * std::numbers::pi * sine * sine, light, lens, frame, exposure);
    }
    case Unit::Candela: {
      if (light.source().is_distant())
        return invalid_argument(
            "a distant light has no intensity in cd; give its distance with --light-distance, or its illuminance in "
            "lx");
      const double distance_m = light.distance_mm / kMm_per_m;
      return sum_of_lux(amount / (distance_m * distance_m), light, lens, frame, exposure);
    }
    case Unit::Lux: return sum_of_lux(amount, light, lens, frame, exposure);
  }
  return amount;
}

Result<double> parse_shutter(std::string_view text) {
  const auto parts = split(text, '/');
  const auto numerator = parse_real(parts[0]),
             denominator = parts.size() > 1 ? parse_real(parts[1]) : Result<double>(1.0);
  const double seconds = numerator && denominator ? *numerator / *denominator : 0.0;
  if (parts.size() <= 2 && seconds >= 1e-6 && seconds <= 1e6) return seconds;
  return invalid_argument(
      fmt::format("\"{}\" is not an exposure time; give seconds from 1e-6 to 1e6, as in 1/50 or 0.02", text));
}

}  // namespace contrejour::params
