// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "contrejour/expert/parameter_text.h"
#include "settings/parameter_tables.h"

namespace contrejour::params {
namespace {

Result<void> check_blades(std::string_view text) {
  const auto blades = parse_integer(text);
  if (!blades || (*blades != 1 && *blades != 2)) return {};
  return invalid_argument(
      fmt::format("{} blades cannot enclose an opening; give 3 blades or more, or 0 for a circular iris", text));
}

// clang-format off: each parameter takes two or three lines, with its help in the last.
const Parameter kLensTable[] = {
    {.name = "focal", .group = "Lens", .kind = Kind::Real, .unit = "mm", .minimum = 0.01, .maximum = 1e5,
     .help = "focal length of a zoom lens (default: its shortest)"},
    {.name = "fnumber", .letter = 'f', .group = "Lens", .kind = Kind::Real, .minimum = 0.1, .maximum = 1000,
     .help = "f-number (default: the lens's maximum aperture)"},
    {.name = "focus", .group = "Lens", .unit = "DISTANCE", .fallback = "inf",
     .help = "distance from the first surface to the plane of focus: 2000 (mm), 2m, inf",
     .check = parses<parse_distance_mm>},
    {.name = "blades", .group = "Lens", .kind = Kind::Integer, .minimum = 0, .maximum = 100, .fallback = "0",
     .help = "number of iris blades, 3 or more; 0: a circular iris", .check = check_blades},
    {.name = "blade-rotation", .group = "Lens", .kind = Kind::Real, .unit = "deg", .minimum = -3600, .maximum = 3600,
     .fallback = "0", .help = "angle of the iris's first corner, counter-clockwise from the right"},
    {.name = "blade-curvature", .group = "Lens", .kind = Kind::Real, .minimum = 0, .maximum = 1, .fallback = "0",
     .help = "curvature of the blades' edges, from 0 (straight) to 1 (the blades form a circle)"},
    {.name = "blade-asymmetry", .group = "Lens", .kind = Kind::Real, .minimum = 0, .maximum = 0.5, .fallback = "0",
     .help = "largest random change of a blade's distance from the centre, as a fraction of that distance"},
    {.name = "blade-seed", .group = "Lens", .kind = Kind::Integer, .minimum = 0, .maximum = kMaxSeed,
     .fallback = "0", .help = "seed of the random displacements of --blade-asymmetry"},
    {.name = "blade-slope-error", .former = "blade-spread", .group = "Lens", .kind = Kind::Real, .minimum = 0,
     .maximum = 0.5, .fallback = "0.1",
     .help = "RMS slope error of curved blades, relative to the angle by which a blade bends; it blurs the ends of the "
             "fans in a starburst; 0: exact arcs"},
    {.name = "blade-closing", .group = "Lens", .kind = Kind::Choice, .fallback = "scaled",
     .help = "how the iris stops down: scaled keeps one shape at every f-number, with its corners on the rim of the "
             "circular stop; mechanism is circular at full aperture, and then the blades emerge from the rim and leave "
             "open the area of the circular stop",
     .choices = {"scaled", "mechanism"}},  // in enum order
    {.name = "iris-image", .group = "Lens", .unit = "FILE",
     .help = "a picture (PNG, EXR) that replaces the blades; its longer side spans the stop, and its level relative to "
             "its brightest is the transmittance; a black-and-white picture with smooth edges is a mask, open where "
             "it is at least half as bright as its brightest"},
    {.name = "tilt", .group = "Lens", .kind = Kind::Real, .unit = "deg", .minimum = 0, .maximum = 5, .fallback = "0",
     .help = "manufacturing error: RMS of the random tilt of each element or cemented group"},
    {.name = "decentre", .group = "Lens", .kind = Kind::Real, .unit = "mm", .minimum = 0, .maximum = 20,
     .fallback = "0", .help = "manufacturing error: RMS of the random decentre of each element or cemented group"},
    {.name = "build-seed", .group = "Lens", .kind = Kind::Integer, .minimum = 0, .maximum = kMaxSeed,
     .fallback = "0", .help = "seed of the random errors of --tilt and --decentre"},
};
// clang-format on

}  // namespace

std::span<const Parameter> lens_parameters() { return kLensTable; }

}  // namespace contrejour::params
