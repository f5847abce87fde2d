// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/dirt.h"

#include "settings/parameter_tables.h"

namespace contrejour::params {
namespace {

// clang-format off: each parameter takes two or three lines, with its help in the last.
const Parameter kDirtTable[] = {
    {.name = "dust", .group = "Lens", .kind = Kind::Real, .unit = "N", .minimum = 0, .maximum = Dirt::kMaxDustPerCm2,
     .fallback = "0", .help = "dust specks per cm^2; 20 is a dusty lens"},
    {.name = "dust-size", .group = "Lens", .kind = Kind::Real, .unit = "mm", .minimum = 0.001, .maximum = 2,
     .fallback = "0.05", .help = "median diameter of dust specks"},
    {.name = "scratches", .group = "Lens", .kind = Kind::Real, .unit = "N", .minimum = 0,
     .maximum = 20, .fallback = "0", .help = "scratches per cm^2; 5 is a worn filter"},
    {.name = "scratch-length", .group = "Lens", .kind = Kind::Real, .unit = "mm", .minimum = 0.01, .maximum = 20,
     .fallback = "5", .help = "median length of scratches"},
    {.name = "scratch-width", .group = "Lens", .kind = Kind::Real, .unit = "mm", .minimum = 0.0001, .maximum = 0.5,
     .fallback = "0.01", .help = "median width of scratches; narrower scratches diffract light into longer streaks"},
    {.name = "scratch-angle", .group = "Lens", .kind = Kind::Real, .unit = "deg", .minimum = -3600, .maximum = 3600,
     .fallback = "0",
     .help = "direction of scratches, counter-clockwise from the right; their streaks are perpendicular to it"},
    {.name = "scratch-spread", .group = "Lens", .kind = Kind::Real, .unit = "deg", .minimum = 0, .maximum = 90,
     .fallback = "90", .help = "largest deviation of a scratch from --scratch-angle; 90: any direction"},
    {.name = "dirt-image", .group = "Lens", .unit = "FILE",
     .help = "a picture (PNG, EXR) of the dirt, white where the lens is clean; its longer side spans the clear "
             "diameter"},
    {.name = "dirt-plane", .former = "dirt-on", .group = "Lens", .kind = Kind::Choice, .fallback = "front",
     .help = "the plane of the dirt: front (as on a filter, so that its shadows move with the light), or stop",
     .choices = {"stop", "front"}},  // in enum order
    {.name = "dirt-seed", .group = "Lens", .kind = Kind::Integer, .minimum = 0, .maximum = kMaxSeed,
     .fallback = "0", .help = "seed of the random dust and scratches"},
    {.name = "dirt-phase", .former = "dirt-time", .group = "Lens", .kind = Kind::Real, .unit = "PERIODS",
     .minimum = -1e6, .maximum = 1e6, .fallback = "0",
     .help = "phase of a slow periodic drift of the dirt, for sequences; whole numbers are the same dirt as 0"},
};
// clang-format on

}  // namespace

std::span<const Parameter> dirt_parameters() { return kDirtTable; }

}  // namespace contrejour::params
