// SPDX-License-Identifier: Apache-2.0
// Parameters of diffraction and scattering: starburst, veiling glare, ringing.
#include "settings/parameter_tables.h"

namespace contrejour::params {
namespace {

// clang-format off: each parameter takes two or three lines, with its help in the last.
const Parameter kEffectTable[] = {
    {.name = "starburst", .group = "Rendering", .kind = Kind::Switch,
     .help = "add the direct image of each light, spread by diffraction at the iris"},
    {.name = "starburst-gain", .group = "Rendering", .kind = Kind::Real, .minimum = 0, .maximum = kMaxGain,
     .fallback = "1", .help = "gain of starbursts; 1 is physically correct"},
    {.name = "glare", .group = "Rendering", .kind = Kind::Real, .minimum = 0, .maximum = 1, .fallback = "0",
     .help = "veiling glare: the fraction of each light that the lens scatters around its image; good lenses: 0.005 to "
             "0.03"},
    {.name = "glare-width", .group = "Rendering", .kind = Kind::Real, .unit = "deg", .minimum = 0.001, .maximum = 80,
     .fallback = "1",
     .help = "angle around the light within which the glare is uniform; beyond, it falls with the cube of the angle"},
    {.name = "ringing", .group = "Rendering", .kind = Kind::Choice, .fallback = "none",
     .help = "diffraction fringes along the edges of ghosts: fresnel computes each ghost's own from its defocus; "
             "hullin uses one pattern for all (hullin2011)",
     .choices = {"none", "fresnel", "hullin"}},  // in enum order
    {.name = "ringing-alpha", .group = "Rendering", .kind = Kind::Real, .minimum = 0, .maximum = 1,
     .help = "order of the fractional Fourier transform of --ringing hullin; 0: none (default: 0.15 (wavelength / 400 "
             "nm) (f-number / 18))"},
    {.name = "threads", .group = "Rendering", .kind = Kind::Integer, .minimum = 0, .maximum = 1024, .fallback = "0",
     .help = "number of threads; 0: one per core. The picture does not depend on it", .scene = true},
};
// clang-format on

}  // namespace

std::span<const Parameter> effect_parameters() { return kEffectTable; }

}  // namespace contrejour::params
