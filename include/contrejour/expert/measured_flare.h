// SPDX-License-Identifier: Apache-2.0
// A flare learned from photographs of a lens turned through a light: its ghosts, each parameter of which is a low-order
// polynomial of the light's position; how it is kept in a file (docs/formats/measured-flare.md); and its pictures.
// Source: walch2018 3.2 and 3.4. Differs: parameters are even or odd functions of the tangent of the light's angle, as
// the lens's symmetry demands; ghosts have colours; a ghost fades in and out at the ends of its range.
// Units: positions and lengths in the picture are tangents of angles (pixels / focal length in pixels) about the
// optical centre, x to the right and y up. A ghost's levels are per unit of that plane's area, relative to the light:
// a level of 1 over an area of 1 sums to as much as the light's direct image.
// Errors: Parse with file and line, Io, InvalidArgument, Cancelled. Thread-safety: plain values, pure functions; the
// pixels are the same bits for any number of threads.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/colour.h"
#include "contrejour/expert/ghost_outline.h"
#include "contrejour/expert/ghost_profile.h"
#include "contrejour/export.h"
#include "contrejour/image.h"
#include "contrejour/result.h"

namespace contrejour {

enum class Parity { Even, Odd, None };

// A polynomial of s, the tangent of the light's angle from the axis: the k-th coefficient multiplies s^(2k) if it is
// even, s^(2k + 1) if it is odd, and s^k otherwise.
struct AngleCurve {
  Parity parity = Parity::Even;
  std::vector<double> coefficients;

  [[nodiscard]] CONTREJOUR_API double operator()(double s) const;
  [[nodiscard]] CONTREJOUR_API double derivative(double s) const;
};

// A ghost's parameters over the angle. Half axes: left = half_width - skew, right = half_width + skew; the control
// lengths likewise.
struct MeasuredGhost {
  std::string name;
  AngleCurve centre{Parity::Odd, {}};
  AngleCurve half_width, skew{Parity::Odd, {}};
  AngleCurve half_height;
  AngleCurve roundness{Parity::Even, {kEllipseRoundness}}, roundness_skew{Parity::Odd, {}};
  // The circle that cuts the outline, as another aperture of the lens does; without coefficients: none.
  AngleCurve clip_centre{Parity::Odd, {}}, clip_radius;
  // How far the border's level reaches: its integral over the distance, over the level; and the exponents of its fall.
  // A side's fade is width * (slope + 1).
  AngleCurve width_in, width_out;
  AngleCurve slope_in{Parity::Even, {1.0}}, slope_out{Parity::Even, {1.0}};
  std::array<AngleCurve, 3> border, inside;  // levels of the channels
  // The profile is added to the inside's level at each place (ghost_profile.h): kProfileTerms curves a channel, or
  // none. Those of cos(phi) are odd, the others even. Their sum with the inside's level is not below 0.
  std::array<std::vector<AngleCurve>, 3> profile;

  // It is there for |s| from first to last, and fades within `transition` of either end (unless that end is the axis or
  // the end of the measured range, which have no transition).
  double first = 0, last = 0, transition = 0;
};

// How the photographs were taken, for the brightness of walch2018's equation 2. Unknown: none.
struct CaptureExposure {
  double f_number = 0, iso = 0, time_s = 0;
};

struct MeasuredFlare {
  std::string name, source;
  double s_max = 0;  // measured for |s| up to this
  std::optional<CaptureExposure> exposure;
  std::vector<MeasuredGhost> ghosts;
  // Half the photographs' field across and down, as tangents from the optical centre. Unknown: none.
  std::optional<Vec2> half_field = {};
};

// Errors: InvalidArgument for values that are not finite, ranges that are empty or exceed s_max, curves that exceed
// 1e9 within s_max.
[[nodiscard]] CONTREJOUR_API Result<void> check_flare(const MeasuredFlare& flare);

[[nodiscard]] CONTREJOUR_API Result<MeasuredFlare> read_flare(std::string_view toml, const std::string& file);
[[nodiscard]] CONTREJOUR_API Result<MeasuredFlare> read_flare(const std::filesystem::path& file);
[[nodiscard]] CONTREJOUR_API std::string write_flare(const MeasuredFlare& flare);  // reads back the same, bit for bit

// A ghost for a light at s >= 0 on the positive x axis, with levels not below 0. None where the ghost is not visible.
struct GhostAtAngle {
  GhostOutline outline;
  GhostShade shade;
  Rgb border{}, inside{};
  double presence = 1;  // by which all levels are multiplied already: below 1 at the ends of its range
  bool has_profile = false;
  std::array<Rgb, kProfileTerms> profile{};  // added to `inside`

  // The level that the inside's weight multiplies at a point, not below 0.
  [[nodiscard]] CONTREJOUR_API Rgb inside_at(Vec2 point) const;
};
[[nodiscard]] CONTREJOUR_API std::optional<GhostAtAngle> ghost_at(const MeasuredGhost& ghost, double s, double s_max);

// walch2018 eq. 2: by how much a flare captured with one exposure and light is brighter in a picture of another. The
// light's part is its luminance times its solid angle; light_ratio: picture over capture.
[[nodiscard]] CONTREJOUR_API double brightness_scale(const CaptureExposure& capture, const CaptureExposure& picture,
                                                     double light_ratio);

// A window of pixels of a picture without distortion. focal_length_px: of the whole picture.
struct TangentFrame {
  int width = 0, height = 0;
  double focal_length_px = 0;
  Vec2 centre_px;  // the optical centre; (0, 0) is the window's top left corner
};

struct FlareLight {
  Vec2 position;  // of its direct image
  Rgb value{1, 1, 1};  // the sum of its direct image over its pixels
};

// The flare of all lights. A light beyond the measured range gives the flare at its end, faded to nothing over a
// fifth of the range. Errors: InvalidArgument (frame without pixels, lights or flare out of range), Cancelled.
[[nodiscard]] CONTREJOUR_API Result<Image> render_measured(const MeasuredFlare& flare,
                                                           std::span<const FlareLight> lights,
                                                           const TangentFrame& frame, const Context& context = {});

}  // namespace contrejour
