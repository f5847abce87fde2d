// SPDX-License-Identifier: Apache-2.0
// Parameters of single methods.
#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/polynomial_method.h"
#include "settings/parameter_tables.h"

namespace contrejour::params {
namespace {

// clang-format off: each parameter takes two or three lines, with its help in the last.
const Parameter kMethodTable[] = {
    {.name = "grid", .group = "Rendering", .kind = Kind::Integer, .minimum = 4, .maximum = 512, .fallback = "256",
     .help = "bundle, tiled: rays along each side of a ghost's grid"},
    {.name = "scale-grid", .group = "Rendering", .kind = Kind::Switch,
     .help = "bundle, tiled: trace fewer rays for small ghosts (bodonyi2023 eq. 13)"},
    {.name = "scale-grid-sigma", .group = "Rendering", .kind = Kind::Real, .minimum = 0, .maximum = 1e6,
     .fallback = "1",
     .help = "with --scale-grid: sigma, the factor on the fraction of the sensor that a ghost covers"},
    {.name = "scale-grid-phi", .group = "Rendering", .kind = Kind::Real, .minimum = 0, .maximum = 4, .fallback = "0.5",
     .help = "with --scale-grid: phi, the exponent of that product"},
    {.name = "grid-levels", .group = "Rendering", .kind = Kind::Switch,
     .help = "bundle: choose each ghost's grid, of 16 to 512 rays a side, by the variance of its cell areas, in place "
             "of --grid"},
    {.name = "mirror-symmetry", .former = "mirror", .group = "Rendering", .kind = Kind::Switch,
     .help = "bundle: trace half of each grid, and mirror it at the light's meridional plane"},
    {.name = "precomputed-pupils", .former = "pupil-table", .group = "Rendering", .kind = Kind::Switch,
     .help = "bundle: take the bounds of ghosts' pupils from a table over field angles, which is computed first, in "
             "place of a search for each light"},
    {.name = "spectral-filter", .group = "Rendering", .kind = Kind::Switch,
     .help = "bundle: at most 7 wavelengths, each blurred towards its neighbours to bridge the gaps between them"},
    {.name = "flat-shading", .group = "Rendering", .kind = Kind::Switch,
     .help = "bundle: constant irradiance within a cell, in place of interpolation between its vertices"},
    {.name = "anisotropic", .group = "Rendering", .kind = Kind::Choice, .fallback = "exact",
     .help = "bundle: how ghosts that are compressed into lines are drawn: exact coverage, high-resolution (4 x 4 "
             "samples a pixel), or points", .choices = {"exact", "high-resolution", "points"}},  // in enum order
    {.name = "merge-steps", .group = "Rendering", .kind = Kind::Integer, .minimum = 0, .maximum = 9, .fallback = "4",
     .help = "tiled: largest number of times that 2 x 2 cells of a flat part of the grid merge into one; 0: never"},
    {.name = "merge-threshold", .group = "Rendering", .kind = Kind::Real, .minimum = 0, .maximum = 1e6,
     .fallback = "0.001",
     .help = "tiled: largest deviation from flatness of cells that merge, in half frame widths; 0.1 merges heavily"},
    {.name = "tile", .group = "Rendering", .kind = Kind::Integer, .unit = "px", .minimum = 1, .maximum = 4096,
     .fallback = "8", .help = "tiled: side of the frame's tiles"},
    {.name = "coarse-tile", .group = "Rendering", .kind = Kind::Integer, .unit = "px", .minimum = 0, .maximum = 4096,
     .fallback = "128",
     .help = "tiled: side of the coarse tiles that primitives are binned into first, a multiple of --tile; 0: none"},
    {.name = "interpolation", .group = "Rendering", .kind = Kind::Choice, .fallback = "loop-derose",
     .help = "tiled: interpolation within a cell",
     .choices = {"triangle", "homogeneous-triangle", "mean-value", "wachspress", "loop-derose"}},  // in enum order
    {.name = "error", .group = "Rendering", .unit = "E|QUALITY", .fallback = "standard",
     .help = "adaptive, polynomial: limit of the RMS error relative to the flare's peak, 0.0001 to 0.1; preview is 0.01, standard "
             "0.003, final 0.001", .check = parses<parse_error_bound>},
    {.name = "fit", .group = "Rendering", .unit = "FILE",
     .help = "polynomial: fit of this lens at these settings, written by `contrejour polynomial fit`; without it, the "
             "ghosts are fitted first"},
    {.name = "points", .group = "Rendering", .kind = Kind::Integer, .minimum = 0,
     .maximum = PolynomialRenderOptions::kMostPoints, .fallback = "0",
     .help = "polynomial: draw each ghost by random points, this many along each side of its opening, in place of "
             "cells, to compare (sabatschus2022); 0: cells"},
    {.name = "density", .group = "Rendering", .kind = Kind::Real, .minimum = 0.05, .maximum = 16, .fallback = "1",
     .help = "reference: sampling density; 2 halves the side of the cells"},
};
// clang-format on

}  // namespace

std::span<const Parameter> method_parameters() { return kMethodTable; }

}  // namespace contrejour::params
