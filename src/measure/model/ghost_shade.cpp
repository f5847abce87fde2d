// SPDX-License-Identifier: Apache-2.0
// The mean of a ghost's shade over a pixel, from integrals of the shade in closed form.
#include <algorithm>
#include <cmath>

#include "contrejour/expert/ghost_outline.h"

namespace contrejour {
namespace {

// The border's part (1 - x / fade)^slope of one side, its integral from the border to x >= 0, and the integral's
// derivatives.
struct FadePart {
  double value = 0;
  double integral = 0;
  double integral_by_fade = 0, integral_by_slope = 0;
};

FadePart fade_part(double x, double fade, double slope) {
  const double whole = fade / (slope + 1.0);
  const double by_fade = 1.0 / (slope + 1.0);
  if (x >= fade) return {0.0, whole, by_fade, -whole / (slope + 1.0)};
  const double rest = 1.0 - x / fade;  // fade > x >= 0
  const double value = std::pow(rest, slope);
  const double beyond = whole * value * rest;  // the integral from x on
  return {value, whole - beyond, by_fade - (value * rest * by_fade + value * x / fade),
          -whole / (slope + 1.0) - beyond * (std::log(rest) - 1.0 / (slope + 1.0))};
}

// The border's weight integrated from far inside to a distance, with its derivatives; and the weight there.
struct Integrated {
  double border = 0, value = 0;
  std::array<double, 4> by_shade{};  // fade_in, fade_out, slope_in, slope_out
};

Integrated integrated(const GhostShade& shade, double distance) {
  const FadePart all = fade_part(shade.fade_in, shade.fade_in, shade.slope_in);
  if (distance <= 0.0) {
    const FadePart part = fade_part(-distance, shade.fade_in, shade.slope_in);
    return {all.integral - part.integral,
            part.value,
            {all.integral_by_fade - part.integral_by_fade, 0.0, all.integral_by_slope - part.integral_by_slope, 0.0}};
  }
  const FadePart part = fade_part(distance, shade.fade_out, shade.slope_out);
  return {all.integral + part.integral,
          part.value,
          {all.integral_by_fade, part.integral_by_fade, all.integral_by_slope, part.integral_by_slope}};
}

}  // namespace

// Inside, the weights of border and inside add to 1.
ShadeWeights shade_weights(const GhostShade& shade, double distance, double pixel_width) {
  const double low = distance - 0.5 * pixel_width, high = distance + 0.5 * pixel_width;
  const Integrated at_low = integrated(shade, low), at_high = integrated(shade, high);
  const double border_inside =
      integrated(shade, std::min(high, 0.0)).border - integrated(shade, std::min(low, 0.0)).border;
  const double covered = std::min(high, 0.0) - std::min(low, 0.0);
  return {(at_high.border - at_low.border) / pixel_width, (covered - border_inside) / pixel_width};
}

ShadeDerivatives shade_derivatives(const GhostShade& shade, double distance, double pixel_width) {
  const double low = distance - 0.5 * pixel_width, high = distance + 0.5 * pixel_width;
  const Integrated at_low = integrated(shade, low), at_high = integrated(shade, high);
  const Integrated in_low = integrated(shade, std::min(low, 0.0)), in_high = integrated(shade, std::min(high, 0.0));
  const auto inside_value = [](double x, const Integrated& at) { return x < 0.0 ? 1.0 - at.value : 0.0; };
  ShadeDerivatives result;
  result.by_distance = {(at_high.value - at_low.value) / pixel_width,
                        (inside_value(high, at_high) - inside_value(low, at_low)) / pixel_width};
  for (std::size_t k = 0; k < result.by_shade.size(); ++k) {
    result.by_shade[k] = {(at_high.by_shade[k] - at_low.by_shade[k]) / pixel_width,
                          -(in_high.by_shade[k] - in_low.by_shade[k]) / pixel_width};
  }
  return result;
}

}  // namespace contrejour
