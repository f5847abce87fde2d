// SPDX-License-Identifier: Apache-2.0
// Parses the texts of parameters: numbers, sizes, lights, colours, coatings, selections of ghosts.
// Errors: InvalidArgument with what was expected; NaN and infinity are refused unless said otherwise.
// Thread-safety: pure functions.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "contrejour/expert/coating.h"
#include "contrejour/expert/colour.h"
#include "contrejour/expert/ghost.h"
#include "contrejour/expert/vec.h"
#include "contrejour/export.h"
#include "contrejour/render.h"
#include "contrejour/result.h"

namespace contrejour::params {

[[nodiscard]] CONTREJOUR_API Result<double> parse_real(std::string_view text);
[[nodiscard]] CONTREJOUR_API Result<int> parse_integer(std::string_view text);
[[nodiscard]] CONTREJOUR_API Result<std::vector<double>> parse_reals(std::string_view text,
                                                                     std::size_t count);  // "1,2,3"
[[nodiscard]] CONTREJOUR_API std::vector<std::string_view> split(std::string_view text, char separator);

// "auto" (FrameSettings::wavelengths' kAutoWavelengths) or a number of wavelengths up to 1024.
[[nodiscard]] CONTREJOUR_API Result<int> parse_wavelengths(std::string_view text);

struct PixelSize {
  int width = 0, height = 0;
};
inline constexpr double kMaxPixels = 268435456.0;  // 2^28, the limit of renderers and readers
[[nodiscard]] CONTREJOUR_API Result<PixelSize> parse_size(std::string_view text);  // "1920x1080"

// "0.1,0.2,0.4,0.5": a part of the picture, 0,0 its top left corner and 1,1 its bottom right one.
struct UvRegion {
  Vec2 from, to;
};
[[nodiscard]] CONTREJOUR_API Result<UvRegion> parse_region(std::string_view text);

// "2000", "2000mm", "200cm", "2m" or "inf".
[[nodiscard]] CONTREJOUR_API Result<double> parse_distance_mm(std::string_view text);

// The sum of a light's direct image: one number (its luminance, with the light's colour), perhaps in a unit that
// settings/photometry.h converts, or three numbers (one for each channel).
struct LightValue {
  enum class Unit {
    Sum,      // the sum of the image
    Stops,    // above white, in each pixel of a disc: "12stops"
    Lux,      // at the lens: "100000lx"
    Candela,  // for a light at a finite distance: "800cd"
    Nits,     // cd/m^2, for a disc: "1.6e9nits"
  };
  Rgb rgb{1, 1, 1};  // per channel, or the amount of the unit in all three
  bool per_channel = false;
  Unit unit = Unit::Sum;
};
[[nodiscard]] CONTREJOUR_API Result<LightValue> parse_light_value(std::string_view text);

// "D65", "A", "E", "3200K", a lamp or a file (spectrum_file.h), or R,G,B.
struct LightColour {
  Spectrum spectrum = IlluminantD65{};
  std::optional<Rgb> rgb;  // if given; else the spectrum's own
};
[[nodiscard]] CONTREJOUR_API Result<LightColour> parse_light_colour(std::string_view text);

// "A,B:VALUE:COLOUR:SIZE:DISTANCE"; parts may be left out at the end, and may be empty before another one.
// "A,B/A,B/..." instead of a position is a path, which the light takes while the shutter is open.
struct LightText {
  std::vector<Vec2> path{{}};  // azimuth and elevation in degrees, or u and v; at evenly spaced times, at least one
  std::optional<LightValue> value;
  std::optional<LightColour> colour;
  std::optional<double> size_deg;     // diameter of a disc
  std::optional<double> distance_mm;  // to the first vertex; may be infinite
};
[[nodiscard]] CONTREJOUR_API Result<LightText> parse_light(std::string_view text);

// A ghost as ghost_name() writes it: "2-5", "2-5-1-4", "7-12@1,-2"; also "5-2" and "2,5".
[[nodiscard]] CONTREJOUR_API Result<Ghost> parse_ghost(std::string_view text);
// Several ghosts, separated by commas: "2-5,3-7"; "2,5,3,7" are the same two.
[[nodiscard]] CONTREJOUR_API Result<std::vector<Ghost>> parse_ghosts(std::string_view text);
// "all", "brightest:N", "flux:P", "surface:K", "list:2-5,3-7".
[[nodiscard]] CONTREJOUR_API Result<GhostSelection> parse_selection(std::string_view text);

// "2-5:gain=0.5,colour=1,0.8,0.6,offset=0.01,-0.02", or "5:..." for all ghosts that reflect at surface 5. Each part is
// optional.
[[nodiscard]] CONTREJOUR_API Result<GhostAdjustment> parse_ghost_adjustment(std::string_view text);
// "-1:1,0.5,0.2/0:1,1,1/1:0.6,0.8,1"
[[nodiscard]] CONTREJOUR_API Result<std::vector<GhostRampStop>> parse_ghost_ramp(std::string_view text);

// "preview", "standard", "final", or a number.
[[nodiscard]] CONTREJOUR_API Result<double> parse_error_bound(std::string_view text);

// "none", "quarter-wave[:NM[:N]]", "hullin[:NM[:N]]", "stack:N@NM,N@NM,..." from air to glass, "measured:FILE".
[[nodiscard]] CONTREJOUR_API Result<Coating> parse_coating(std::string_view text);

// "12:v-coat:550": a surface by its number, and its coating.
[[nodiscard]] CONTREJOUR_API Result<SurfaceCoating> parse_coating_at(std::string_view text);

// A plane-parallel plate in front of the sensor: "2", "2:N-BK7" or "2:1.52:0.8": its thickness in mm, its glass or
// index (default: N-BK7), and the gap behind it in mm (default: 1).
[[nodiscard]] CONTREJOUR_API Result<SensorPlate> parse_cover_glass(std::string_view text);

}  // namespace contrejour::params
