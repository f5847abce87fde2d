// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/measured_flare.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "measure/model/flare_curves.h"

namespace contrejour {
namespace {

// Bounds of what a ghost may be: an outline keeps a size, a shade's exponent stays where its integral is well defined.
constexpr double kMinHalfAxis = 1e-7;
constexpr double kMinRoundness = 0.05, kMaxRoundness = 1.0;
constexpr double kMinSlope = 0.05, kMaxSlope = 30.0;
// The squares of lengths in pixels, and levels times a light's value, stay within the range of a float.
constexpr double kMaxCurve = 1e9;
constexpr double kMaxHalfField = 1000.0;

// 0 to 1 over [0, 1], with a slope of 0 at both ends.
double smooth_step(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// How much of a ghost is there, at s >= 0.
double presence(const MeasuredGhost& ghost, double s, double s_max) {
  if (s < ghost.first || s > ghost.last) return 0.0;
  if (ghost.transition <= 0.0) return 1.0;
  const double begins = ghost.first > 0.0 ? smooth_step((s - ghost.first) / ghost.transition) : 1.0;
  const double ends = ghost.last < s_max ? smooth_step((ghost.last - s) / ghost.transition) : 1.0;
  return begins * ends;
}

bool is_half_field(double tangent) { return tangent > 0.0 && tangent <= kMaxHalfField; }

// No value of the curve is larger for |s| up to s_max.
double bound_of(const AngleCurve& curve, double s_max) {
  AngleCurve sizes = curve;
  for (double& coefficient : sizes.coefficients) coefficient = std::abs(coefficient);
  return sizes(s_max);
}

Result<void> check_ghost(const MeasuredGhost& ghost, double s_max) {
  for (const AngleCurve* curve : curves_of(ghost)) {
    if (!(bound_of(*curve, s_max) <= kMaxCurve)) {
      return invalid_argument(
          fmt::format("ghost \"{}\": a coefficient is not finite, or the curve exceeds {:g}", ghost.name, kMaxCurve));
    }
  }
  for (const std::vector<AngleCurve>& terms : ghost.profile) {
    const bool bounded =
        std::ranges::all_of(terms, [&](const AngleCurve& curve) { return bound_of(curve, s_max) <= kMaxCurve; });
    if (!bounded || (!terms.empty() && terms.size() != kProfileTerms) || terms.size() != ghost.profile[0].size()) {
      return invalid_argument(
          fmt::format("ghost \"{}\": a profile has {} curves of each channel, which do not exceed {:g}", ghost.name,
                      kProfileTerms, kMaxCurve));
    }
  }
  if (!(ghost.first >= 0.0 && ghost.first < ghost.last && ghost.last <= s_max && ghost.transition >= 0.0)) {
    return invalid_argument(
        fmt::format("ghost \"{}\": it must be visible from first >= 0 to a larger last, no farther than s_max = {:g}",
                    ghost.name, s_max));
  }
  return {};
}

}  // namespace

double AngleCurve::operator()(double s) const {
  const double x = parity == Parity::None ? s : s * s;
  double value = 0.0;
  for (std::size_t k = coefficients.size(); k > 0; --k) value = value * x + coefficients[k - 1];
  return parity == Parity::Odd ? value * s : value;
}

double AngleCurve::derivative(double s) const {
  const int step = parity == Parity::None ? 1 : 2, first = parity == Parity::Odd ? 1 : 0;
  double value = 0.0;
  for (std::size_t k = 0; k < coefficients.size(); ++k) {
    const int power = first + step * static_cast<int>(k);
    if (power > 0) value += power * coefficients[k] * std::pow(s, power - 1);
  }
  return value;
}

Result<void> check_flare(const MeasuredFlare& flare) {
  if (!(flare.s_max > 0.0 && std::isfinite(flare.s_max))) {
    return invalid_argument(fmt::format("s_max must be above 0: {:g}", flare.s_max));
  }
  if (const auto& half = flare.half_field; half && !(is_half_field(half->x) && is_half_field(half->y))) {
    return invalid_argument(fmt::format("half_field must be two tangents above 0: {:g}, {:g}", half->x, half->y));
  }
  for (const MeasuredGhost& ghost : flare.ghosts) {
    if (Result<void> ok = check_ghost(ghost, flare.s_max); !ok) return ok;
  }
  return {};
}

std::optional<GhostAtAngle> ghost_at(const MeasuredGhost& ghost, double s, double s_max) {
  const double level = presence(ghost, s, s_max);
  if (level <= 0.0) return std::nullopt;
  const double width = ghost.half_width(s), skew = ghost.skew(s), height = ghost.half_height(s);
  if (!(width > kMinHalfAxis && height > kMinHalfAxis)) return std::nullopt;  // it has shrunk to nothing
  const double roundness = ghost.roundness(s), roundness_skew = ghost.roundness_skew(s);
  GhostAtAngle at;
  at.outline = {ghost.centre(s),
                std::max(width - skew, kMinHalfAxis),
                std::max(width + skew, kMinHalfAxis),
                height,
                std::clamp(roundness - roundness_skew, kMinRoundness, kMaxRoundness),
                std::clamp(roundness + roundness_skew, kMinRoundness, kMaxRoundness),
                ghost.clip_centre(s),
                ghost.clip_radius.coefficients.empty() ? 0.0 : std::max(ghost.clip_radius(s), kMinHalfAxis)};
  const double slope_in = std::clamp(ghost.slope_in(s), kMinSlope, kMaxSlope);
  const double slope_out = std::clamp(ghost.slope_out(s), kMinSlope, kMaxSlope);
  at.shade = {(slope_in + 1.0) * std::max(ghost.width_in(s), 0.0),
              (slope_out + 1.0) * std::max(ghost.width_out(s), 0.0), slope_in, slope_out};
  for (std::size_t c = 0; c < at.border.size(); ++c) {
    at.border[c] = level * std::max(ghost.border[c](s), 0.0);
    at.inside[c] = level * std::max(ghost.inside[c](s), 0.0);
  }
  at.presence = level;
  at.has_profile = !ghost.profile[0].empty();
  for (std::size_t k = 0; k < kProfileTerms && at.has_profile; ++k) {
    for (std::size_t c = 0; c < at.inside.size(); ++c) at.profile[k][c] = level * ghost.profile[c][k](s);
  }
  return at;
}

Rgb GhostAtAngle::inside_at(Vec2 point) const {
  Rgb level = inside;
  if (!has_profile) return level;
  const ProfileWeights weights = profile_weights(outline, point);
  for (std::size_t c = 0; c < level.size(); ++c) {
    for (std::size_t k = 0; k < weights.term.size(); ++k) level[c] += weights.value[k] * profile[weights.term[k]][c];
    level[c] = std::max(level[c], 0.0);
  }
  return level;
}

double brightness_scale(const CaptureExposure& capture, const CaptureExposure& picture, double light_ratio) {
  const double f_ratio = capture.f_number / picture.f_number;
  return f_ratio * f_ratio * (picture.iso / capture.iso) * (picture.time_s / capture.time_s) * light_ratio;
}

}  // namespace contrejour
