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

FadePart whole_fade(double fade, double slope) {
  const double by_fade = 1.0 / (slope + 1.0), whole = fade * by_fade;
  return {0.0, whole, by_fade, -whole * by_fade};
}

FadePart fade_part(double x, double fade, double slope) {
  if (x <= 0.0 && fade > 0.0) return {1.0, 0.0, 0.0, 0.0};
  const FadePart all = whole_fade(fade, slope);
  if (x >= fade) return all;
  const double rest = 1.0 - x / fade, log_rest = std::log(rest);  // fade > x > 0
  const double value = std::exp(slope * log_rest), by_fade = all.integral_by_fade;
  const double beyond = all.integral * value * rest;  // the integral from x on
  return {value, all.integral - beyond, by_fade - (value * rest * by_fade + value * x / fade),
          all.integral_by_slope - beyond * (log_rest - by_fade)};
}

// The border's weight integrated from far inside to a distance, with its derivatives; and the weight there.
struct Integrated {
  double border = 0, value = 0;
  std::array<double, 4> by_shade{};  // fade_in, fade_out, slope_in, slope_out
};

Integrated integrated(const GhostShade& shade, double distance) {
  const FadePart all = whole_fade(shade.fade_in, shade.slope_in);
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

// A pixel from one distance to another, and the part of it that lies inside.
struct PixelIntegrals {
  double low = 0, high = 0;
  Integrated at_low, at_high, inside_low, inside_high;
};

PixelIntegrals pixel_integrals(const GhostShade& shade, double distance, double pixel_width) {
  PixelIntegrals p;
  p.low = distance - 0.5 * pixel_width;
  p.high = distance + 0.5 * pixel_width;
  p.at_low = integrated(shade, p.low);
  p.at_high = integrated(shade, p.high);
  p.inside_low = p.low <= 0.0 ? p.at_low : integrated(shade, 0.0);
  p.inside_high = p.high <= 0.0 ? p.at_high : integrated(shade, 0.0);
  return p;
}

// Inside, the weights of border and inside add to 1.
ShadeWeights weights_of(const PixelIntegrals& p, double pixel_width) {
  const double border_inside = p.inside_high.border - p.inside_low.border;
  const double covered = std::min(p.high, 0.0) - std::min(p.low, 0.0);
  return {(p.at_high.border - p.at_low.border) / pixel_width, (covered - border_inside) / pixel_width};
}

}  // namespace

ShadeWeights shade_weights(const GhostShade& shade, double distance, double pixel_width) {
  return weights_of(pixel_integrals(shade, distance, pixel_width), pixel_width);
}

ShadeDerivatives shade_derivatives(const GhostShade& shade, double distance, double pixel_width) {
  const PixelIntegrals p = pixel_integrals(shade, distance, pixel_width);
  const auto inside_value = [](double x, const Integrated& at) { return x < 0.0 ? 1.0 - at.value : 0.0; };
  ShadeDerivatives result;
  result.weights = weights_of(p, pixel_width);
  result.by_distance = {(p.at_high.value - p.at_low.value) / pixel_width,
                        (inside_value(p.high, p.at_high) - inside_value(p.low, p.at_low)) / pixel_width};
  for (std::size_t k = 0; k < result.by_shade.size(); ++k) {
    result.by_shade[k] = {(p.at_high.by_shade[k] - p.at_low.by_shade[k]) / pixel_width,
                          -(p.inside_high.by_shade[k] - p.inside_low.by_shade[k]) / pixel_width};
  }
  return result;
}

}  // namespace contrejour
