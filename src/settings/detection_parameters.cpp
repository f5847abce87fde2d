// SPDX-License-Identifier: Apache-2.0
// Parameters of lights in photographs, of the gain of their flare, and of output.
#include <string>

#include <fmt/format.h>

#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/spectrum_file.h"
#include "settings/parameter_tables.h"

namespace contrejour::params {
namespace {

Result<void> check_spectrum(std::string_view text) {
  const auto spectrum = find_spectrum(std::string(text));
  if (!spectrum) return tl::unexpected(spectrum.error());
  return {};
}

Result<void> check_exposure(std::string_view text) {
  if (text == "auto") return {};
  const auto stops = parse_real(text);
  if (stops && *stops >= -100.0 && *stops <= 100.0) return {};
  return invalid_argument(fmt::format("\"{}\" is not an exposure; give auto, or stops from -100 to 100", text));
}

// clang-format off: each parameter takes two or three lines, with its help in the last.
const Parameter kDetectionTable[] = {
    {.name = "detect", .group = "Light detection", .kind = Kind::Switch, .fallback = "on",
     .help = "treat bright areas of the picture as lights; off: only the lights of --light and --light-at",
     .scene = true},
    {.name = "region", .group = "Light detection", .unit = "U,V,U,V",
     .help = "detect lights only between these two corners (0,0 is the top left of the picture, 1,1 the bottom right), "
             "with a threshold derived from this region alone; may be repeated",
     .repeats = true, .scene = true, .check = parses<parse_region>},
    {.name = "threshold", .group = "Light detection", .kind = Kind::Real, .minimum = 0, .maximum = kMaxGain,
     .help = "level above which a pixel belongs to a light (default: derived from the picture)", .scene = true},
    {.name = "softness", .group = "Light detection", .kind = Kind::Real, .minimum = 0, .maximum = 1000,
     .fallback = "0.25", .help = "width of the threshold: a pixel has full weight from threshold x (1 + softness)",
     .scene = true},
    {.name = "max-lights", .group = "Light detection", .kind = Kind::Integer, .minimum = 1, .maximum = 100000,
     .fallback = "8",
     .help = "largest number of lights; further areas are merged into the nearest of them, so that no flux is lost",
     .scene = true},
    {.name = "min-pixels", .group = "Light detection", .kind = Kind::Integer, .minimum = 1, .maximum = 1000000000,
     .fallback = "1", .help = "smallest area of a light in pixels; smaller areas, such as hot pixels, are ignored",
     .scene = true},
    {.name = "max-value", .group = "Light detection", .kind = Kind::Real, .minimum = 1e-6, .maximum = 1e10,
     .fallback = "1e10",
     .help = "level to which brighter pixels are clamped, in their own colour: hot pixels, or a sun that is too bright",
     .scene = true},
    {.name = "light-shape", .group = "Light detection", .kind = Kind::Switch, .fallback = "on",
     .help = "give lights the shape of their pixels, for ghosts and starbursts; off: points at their centroids",
     .scene = true},
    {.name = "spectrum", .group = "Light detection", .unit = "SPECTRUM", .fallback = "D65",
     .help = "spectrum of the detected lights within each channel: D65, A, E, 3200K, led, sodium, ... as for --colour",
     .scene = true, .check = check_spectrum},
    {.name = "gain", .group = "Light detection", .kind = Kind::Real, .minimum = 0, .maximum = kMaxGain,
     .fallback = "1", .help = "gain of the flare; 1 is physically correct"},
    {.name = "stops", .group = "Light detection", .kind = Kind::Real, .unit = "STOPS", .minimum = -40, .maximum = 40,
     .fallback = "0", .help = "gain of the flare in stops, in addition to --gain; 0 is physically correct"},

    {.name = "exposure", .group = "Output", .unit = "STOPS|auto",
     .help = "exposure of PNG previews; auto: from the brightest parts of the picture",
     .scene = true, .check = check_exposure},
    {.name = "wavelength", .group = "Lens", .kind = Kind::Real, .unit = "nm", .minimum = 300, .maximum = 1100,
     .help = "wavelength (default: the lens's design wavelength)", .scene = true},
};
// clang-format on

}  // namespace

std::span<const Parameter> detection_parameters() { return kDetectionTable; }

}  // namespace contrejour::params
