// SPDX-License-Identifier: Apache-2.0
// Parameters of rendering that all methods have: the name of the method, wavelengths, and the ghosts to draw.
#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "contrejour/expert/parameter_text.h"
#include "contrejour/render.h"
#include "settings/parameter_tables.h"

namespace contrejour::params {
namespace {

Result<void> check_method(std::string_view text) {
  const auto methods = render_methods();
  if (std::find(methods.begin(), methods.end(), text) != methods.end()) return {};
  return invalid_argument(fmt::format("\"{}\" is not a method; choose one of {}", text, fmt::join(methods, ", ")));
}

// clang-format off: each parameter takes two or three lines, with its help in the last.
const Parameter kGhostTable[] = {
    {.name = "method", .group = "Rendering", .unit = "METHOD", .fallback = "adaptive",
     .help = "adaptive, bundle (hullin2011), tiled (bodonyi2023) or reference (exact and slow)", .check = check_method},
    {.name = "device", .group = "Rendering", .kind = Kind::Choice, .fallback = "cpu",
     .help = "the device that renders: the CPU; a GPU by Vulkan, which CONTREJOUR_DEVICE chooses by index or name; auto: "
             "a GPU where there is one (contrejour devices lists them)", .choices = {"cpu", "vulkan", "auto"},
     .scene = true},
    {.name = "wavelengths", .group = "Rendering", .unit = "N", .fallback = "auto",
     .help = "number of bands of the visible spectrum, 1 to 1024; auto: for each ghost as many as its dispersion and "
             "the coatings require", .check = parses<parse_wavelengths>},
    {.name = "colour-space", .group = "Rendering", .kind = Kind::Choice,
     .help = "linear working colour space (default: the picture's, else rec709)", .choices = {"rec709", "acescg"}},
    {.name = "ghosts", .group = "Rendering", .kind = Kind::Choice, .fallback = "all",
     .help = "all: every pair of surfaces; one-side: only pairs on the same side of the stop, as in the papers",
     .choices = {"one-side", "all"}},
    {.name = "reflections", .group = "Rendering", .kind = Kind::Choice, .fallback = "2",
     .help = "largest number of reflections; 4 adds ghosts of four reflections, which are numerous and dim",
     .choices = {"2", "4"}},
    {.name = "select", .group = "Rendering", .unit = "SELECTION", .fallback = "all",
     .help = "the ghosts to draw: all, brightest:N, flux:PERCENT (omits the weakest, which together carry at most this "
             "percentage of the flux), surface:K (all that reflect there), list:2-5,3-7",
     .check = parses<parse_selection>},
    {.name = "ghost", .group = "Rendering", .unit = "I-J|K:gain=G,colour=R,G,B,offset=X,Y",
     .help = "adjust one ghost, named by its two surfaces (2-5), or all that reflect at one surface (5): multiply it "
             "by a gain or a colour, and move it to the right and up by fractions of the frame's height; may be "
             "repeated",
     .repeats = true, .check = parses<parse_ghost_adjustment>},
    {.name = "ghost-gain", .group = "Rendering", .kind = Kind::Real, .minimum = 0, .maximum = kMaxGain, .fallback = "1",
     .help = "gain of all ghosts; 1 is physically correct"},
    {.name = "ghost-edge-gain", .group = "Rendering", .kind = Kind::Real, .minimum = 0, .maximum = kMaxGain,
     .fallback = "1", .help = "gain of the ghosts of a light at the frame's corner, linear from 1 at the centre"},
    {.name = "ghost-ramp", .group = "Rendering", .unit = "POSITION:R,G,B/...",
     .help = "colour ramp by which ghosts are multiplied according to their position: 1 at the light's image, 0 at the "
             "frame's centre, -1 opposite the light", .check = parses<parse_ghost_ramp>},
    {.name = "ghost-jitter", .former = "ghost-scatter", .group = "Rendering", .kind = Kind::Real, .minimum = 0,
     .maximum = 10, .fallback = "0",
     .help = "RMS of a random offset of each ghost, as a fraction of the frame's height (hullin2011's 'imperfect "
             "symmetry')"},
    {.name = "ghost-seed", .group = "Rendering", .kind = Kind::Integer, .minimum = 0, .maximum = kMaxSeed,
     .fallback = "0", .help = "seed of the random offsets of --ghost-jitter"},
};
// clang-format on

}  // namespace

std::span<const Parameter> ghost_parameters() { return kGhostTable; }

}  // namespace contrejour::params
