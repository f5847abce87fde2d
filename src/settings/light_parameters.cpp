// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/parameter_text.h"
#include "settings/parameter_tables.h"
#include "settings/photometry.h"

namespace contrejour::params {
namespace {

// clang-format off: each parameter takes two or three lines, with its help in the last.
const Parameter kLightTable[] = {
    {.name = "light", .group = "Lights", .unit = "AZ,EL[:VALUE[:COLOUR[:SIZE[:DISTANCE]]]]",
     .help = "a light by its direction, in degrees to the right and up; may be repeated", .repeats = true,
     .scene = true, .check = parses<parse_light>},
    {.name = "light-at", .group = "Lights", .unit = "U,V[:VALUE[:COLOUR[:SIZE[:DISTANCE]]]]",
     .help = "a light by the position of its image: 0,0 is the top left corner of the frame and 1,1 the bottom right; "
             "the image may lie outside the frame; may be repeated",
     .repeats = true, .scene = true, .check = parses<parse_light>},
    {.name = "value", .group = "Lights", .unit = "V|R,G,B", .fallback = "1",
     .help = "brightness: the sum of the light's direct image over its pixels, with white at 1 (a lamp of 50 pixels, "
             "each 100 times white: 5000); or 12stops above white in each pixel of a disc (--light-size), 100000lx at "
             "the lens, 800cd (--light-distance) or 1.6e9nits of a disc, exposed by --iso and --shutter",
     .scene = true, .check = parses<parse_light_value>},
    {.name = "iso", .group = "Lights", .kind = Kind::Real, .minimum = 0.1, .maximum = 1e8, .fallback = "100",
     .help = "exposure index, for lights in lx, cd and nits", .scene = true},
    {.name = "shutter", .group = "Lights", .unit = "SECONDS", .fallback = "1/50",
     .help = "exposure time, 1/50 or 0.02, for lights in lx, cd and nits; the f-number is the lens's", .scene = true,
     .check = parses<parse_shutter>},
    {.name = "colour", .group = "Lights", .unit = "COLOUR", .fallback = "D65",
     .help = "D65, A, E, a colour temperature such as 3200K, led, sodium, sodium-low, fluorescent, fluorescent-narrow, "
             "a file of wavelengths and powers, or R,G,B", .scene = true, .check = parses<parse_light_colour>},
    {.name = "light-distance", .group = "Lights", .unit = "DISTANCE", .fallback = "inf",
     .help = "distance of the lights from the first surface: 500 (mm), 2m, inf; a light that is nearer than the plane "
             "of focus has different ghosts", .scene = true, .check = parses<parse_distance_mm>},
    {.name = "light-size", .group = "Lights", .kind = Kind::Real, .unit = "deg", .minimum = 0, .maximum = 90,
     .fallback = "0", .help = "angular diameter of the lights, which are discs; 0.53 for the sun; 0: points",
     .scene = true},
    {.name = "shutter-angle", .group = "Lights", .kind = Kind::Real, .unit = "deg", .minimum = 0, .maximum = 360,
     .fallback = "0", .help = "motion blur of what changes in --lights: the shutter is open for DEG/360 of a frame; "
             "180 is usual; 0: none", .scene = true},
    {.name = "shutter-offset", .group = "Lights", .kind = Kind::Choice, .fallback = "start",
     .help = "whether the shutter opens at the frame's time, or is open for as long before it as after it",
     .choices = {"start", "centre"}, .scene = true},
};

const Parameter kFrameTable[] = {
    {.name = "size", .group = "Frame", .unit = "WxH", .fallback = "1920x1080", .help = "size of the picture in pixels",
     .scene = true, .check = parses<parse_size>},
    {.name = "hfov", .group = "Frame", .kind = Kind::Real, .unit = "deg", .minimum = 0.01, .maximum = 175,
     .help = "horizontal field of view of the whole frame (default: the frame fits the lens's sensor)", .scene = true},
    {.name = "pixel-aspect", .group = "Frame", .kind = Kind::Real, .minimum = 0.1, .maximum = 10,
     .help = "pixel aspect ratio of the displayed picture, width over height; 2 for many anamorphic plates (default: "
             "the input file's; for a rendered frame, pixels that are square on the sensor)", .scene = true},
};
// clang-format on

}  // namespace

std::span<const Parameter> light_parameters() { return kLightTable; }
std::span<const Parameter> frame_parameters() { return kFrameTable; }

}  // namespace contrejour::params
