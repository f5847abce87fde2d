// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "contrejour/expert/parameter.h"
#include "contrejour/expert/parameter_text.h"
#include "contrejour/expert/spectrum_file.h"
#include "contrejour/render.h"
#include "settings/photometry.h"
#include "settings/sensor_format.h"

namespace contrejour::params {
namespace {

// Uses a parser as a check: discards its value.
template <auto parse>
Result<void> parses(std::string_view text) {
  const auto value = parse(text);
  if (!value) return tl::unexpected(value.error());
  return {};
}

Result<void> check_method(std::string_view text) {
  const auto methods = render_methods();
  if (std::find(methods.begin(), methods.end(), text) != methods.end()) return {};
  return failure(ErrorCode::InvalidArgument,
                 fmt::format("\"{}\" is no method; there are {}", text, fmt::join(methods, ", ")));
}

Result<void> check_spectrum(std::string_view text) {
  const auto spectrum = find_spectrum(std::string(text));
  if (!spectrum) return tl::unexpected(spectrum.error());
  return {};
}

Result<void> check_exposure(std::string_view text) {
  if (text == "auto") return {};
  const auto stops = parse_real(text);
  if (stops && *stops >= -100.0 && *stops <= 100.0) return {};
  return failure(ErrorCode::InvalidArgument, fmt::format("\"{}\" is neither auto nor stops from -100 to 100", text));
}

Result<void> check_blades(std::string_view text) {
  const auto blades = parse_integer(text);
  if (!blades || (*blades != 1 && *blades != 2)) return {};
  return failure(ErrorCode::InvalidArgument,
                 fmt::format("{} straight edges close no opening: give 3 blades or more, or 0 for a circle", text));
}

constexpr double kBig = 1e12;

// clang-format off: each parameter takes two or three lines, with its help in the last.
const Parameter kTable[] = {
    {.name = "focal", .group = "Lens", .kind = Kind::Real, .unit = "mm", .minimum = 0.01, .maximum = 1e5,
     .help = "focal length of a zoom (default: its shortest)"},
    {.name = "fnumber", .letter = 'f', .group = "Lens", .kind = Kind::Real, .minimum = 0.1, .maximum = 1000,
     .help = "f-number (default: the lens's widest)"},
    {.name = "focus", .group = "Lens", .unit = "DISTANCE", .fallback = "inf",
     .help = "distance of the object in focus from the first surface: 2000 (mm), 2m, inf",
     .check = parses<parse_distance_mm>},
    {.name = "blades", .group = "Lens", .kind = Kind::Integer, .minimum = 0, .maximum = 100, .fallback = "0",
     .help = "blades of the iris, 3 or more; 0: a circle", .check = check_blades},
    {.name = "blade-rotation", .group = "Lens", .kind = Kind::Real, .unit = "deg", .minimum = -3600, .maximum = 3600,
     .fallback = "0", .help = "the iris's first corner, counter-clockwise from the right"},
    {.name = "blade-curvature", .group = "Lens", .kind = Kind::Real, .minimum = 0, .maximum = 1, .fallback = "0",
     .help = "how round the blades' edges are: 0 straight, 1 a circle together"},
    {.name = "blade-asymmetry", .group = "Lens", .kind = Kind::Real, .minimum = 0, .maximum = 0.5, .fallback = "0",
     .help = "blades stand nearer or farther by up to this share, each by its own"},
    {.name = "blade-seed", .group = "Lens", .kind = Kind::Integer, .minimum = 0, .maximum = 1000000000,
     .fallback = "0", .help = "which of the irises of such asymmetry"},
    {.name = "blade-spread", .group = "Lens", .kind = Kind::Real, .minimum = 0, .maximum = 0.5, .fallback = "0.1",
     .help = "how far curved blades are from exact arcs: RMS of their slopes over the angle by which each bends; "
             "smears the ends of the fans in a starburst"},
    {.name = "blade-closing", .group = "Lens", .kind = Kind::Choice, .unit = "HOW", .fallback = "scaled",
     .help = "scaled: one shape at every f-number, its corners on the round stop's rim; mechanism: round wide open, "
             "then blades come out of the rim and leave the round stop's area",
     .choices = {"scaled", "mechanism"}},  // in enum order
    {.name = "iris-image", .group = "Lens", .unit = "FILE",
     .help = "a picture (PNG, EXR) as the iris in place of blades, its longer side across the stop: its level over its "
             "brightest is the share of light that passes; one of black and white with smooth edges is a mask, open "
             "where it is at least half as bright as at its brightest"},
    {.name = "tilt", .group = "Lens", .kind = Kind::Real, .unit = "deg", .minimum = 0, .maximum = 5, .fallback = "0",
     .help = "each element, or group of cemented ones, is tilted by its own random angle, RMS"},
    {.name = "decentre", .group = "Lens", .kind = Kind::Real, .unit = "mm", .minimum = 0, .maximum = 20,
     .fallback = "0", .help = "and moved to a side by its own random way, RMS"},
    {.name = "build-seed", .group = "Lens", .kind = Kind::Integer, .minimum = 0, .maximum = 1000000000,
     .fallback = "0", .help = "which of the lenses of such tilt and decentre"},
    {.name = "dust", .group = "Lens", .kind = Kind::Real, .unit = "N", .minimum = 0, .maximum = Dirt::kMaxDustPerCm2,
     .fallback = "0", .help = "specks of dust per cm^2; a clean lens has none, a dusty one 20"},
    {.name = "dust-size", .group = "Lens", .kind = Kind::Real, .unit = "mm", .minimum = 0.001, .maximum = 2,
     .fallback = "0.05", .help = "typical diameter of specks"},
    {.name = "scratches", .group = "Lens", .kind = Kind::Real, .unit = "N", .minimum = 0,
     .maximum = 20, .fallback = "0", .help = "scratches per cm^2; a worn filter has 5"},
    {.name = "scratch-length", .group = "Lens", .kind = Kind::Real, .unit = "mm", .minimum = 0.01, .maximum = 20,
     .fallback = "5", .help = "typical length of scratches"},
    {.name = "scratch-width", .group = "Lens", .kind = Kind::Real, .unit = "mm", .minimum = 0.0001, .maximum = 0.5,
     .fallback = "0.01", .help = "typical width of scratches: the finer, the longer their streaks"},
    {.name = "scratch-angle", .group = "Lens", .kind = Kind::Real, .unit = "deg", .minimum = -3600, .maximum = 3600,
     .fallback = "0", .help = "direction of scratches, counter-clockwise from the right; streaks lie across it"},
    {.name = "scratch-spread", .group = "Lens", .kind = Kind::Real, .unit = "deg", .minimum = 0, .maximum = 90,
     .fallback = "90", .help = "scratches turn by up to so much from that direction; 90: any way"},
    {.name = "dirt-image", .group = "Lens", .unit = "FILE",
     .help = "a picture (PNG, EXR) as dirt, white where it is clean, its longer side across the front or the stop"},
    {.name = "dirt-on", .group = "Lens", .kind = Kind::Choice, .unit = "PLANE", .fallback = "front",
     .help = "where dust and scratches lie: front (as on a filter: they pass by as the light moves) or stop",
     .choices = {"stop", "front"}},  // in enum order
    {.name = "dirt-seed", .group = "Lens", .kind = Kind::Integer, .minimum = 0, .maximum = 1000000000,
     .fallback = "0", .help = "which of the lenses with so much dirt"},
    {.name = "dirt-time", .group = "Lens", .kind = Kind::Real, .unit = "TURNS", .minimum = -1e6, .maximum = 1e6,
     .fallback = "0", .help = "0: dirt lies still; else it has wandered, and is back at every whole number"},
    {.name = "coating", .group = "Lens", .unit = "COATING",
     .help = "coating layers on every surface to the air instead of the lens's own: none, quarter-wave:550:1.38, "
             "hullin:550:1.38, stack:MgF2@99.6,ZrO2@0.5w, v-coat, broadband-5:550, measured:FILE (a table, R over nm and degrees), "
             "...",
     .check = parses<parse_coating>},
    {.name = "coating-at", .group = "Lens", .unit = "SURFACE:COATING",
     .help = "a coating for one surface: 12:v-coat:550, 3:none; may be repeated", .repeats = true,
     .check = parses<parse_coating_at>},
    {.name = "absorption", .group = "Lens", .kind = Kind::Switch,
     .help = "glass absorbs on the way through it, where its catalogue says how much"},
    {.name = "cover-glass", .group = "Lens", .unit = "MM[:GLASS[:GAP]]",
     .help = "a plane plate before the sensor, of N-BK7 and 1 mm in front of what follows unless given: 2, 2:1.52:0.8; "
             "from the lens on; may be repeated",
     .repeats = true, .check = parses<parse_cover_glass>},
    {.name = "sensor", .group = "Lens", .unit = "NAME|WxH",
     .help = "size of the sensor in place of the lens's own: mm as 24.9x18.7, or full-frame, aps-c, four-thirds, "
             "one-inch, medium-format, super35, super16, 65mm, imax, alexa-lf, ... (docs/cli.md)",
     .scene = true, .check = parses<parse_sensor>},
    {.name = "sensor-reflectance", .group = "Lens", .kind = Kind::Real, .minimum = 0, .maximum = 1, .fallback = "0",
     .help = "share of the light that the sensor sends back into the lens; some 0.05 to 0.2"},
    {.name = "sensor-orders", .group = "Lens", .kind = Kind::Integer, .minimum = 0,
     .maximum = SensorStack::kMaxOrders, .fallback = "0",
     .help = "its pixels are a grating: so many orders to each side (dots about a light, red outwards); 0: a mirror"},
    {.name = "sensor-pitch", .group = "Lens", .kind = Kind::Real, .unit = "um", .minimum = 0.1, .maximum = 1000,
     .fallback = "5", .help = "period of that grating"},
    {.name = "sensor-fill", .group = "Lens", .kind = Kind::Real, .minimum = 0.01, .maximum = 1, .fallback = "0.8",
     .help = "side of its reflecting squares over the period"},

    {.name = "light", .group = "Lights", .unit = "AZ,EL[:VALUE[:COLOUR[:SIZE]]]",
     .help = "a light so many degrees to the right and up; may be repeated", .repeats = true,
     .scene = true, .check = parses<parse_light>},
    {.name = "light-at", .group = "Lights", .unit = "U,V[:VALUE[:COLOUR[:SIZE]]]",
     .help = "a light whose image lands there: 0,0 top left, 1,1 bottom right, outside too; may be repeated",
     .repeats = true, .scene = true, .check = parses<parse_light>},
    {.name = "value", .group = "Lights", .unit = "V|R,G,B", .fallback = "1",
     .help = "brightness: what a light's own image sums to over its pixels, white being 1 (a lamp of 50 pixels, each 100 "
             "times white: 5000); or 12stops over white in each pixel of a disc (--light-size), 100000lx at the lens, "
             "800cd (--light-distance), 1.6e9nits of a disc, at --iso and --shutter",
     .scene = true, .check = parses<parse_light_value>},
    {.name = "iso", .group = "Lights", .kind = Kind::Real, .minimum = 0.1, .maximum = 1e8, .fallback = "100",
     .help = "exposure index, for lights in lx, cd and nits", .scene = true},
    {.name = "shutter", .group = "Lights", .unit = "SECONDS", .fallback = "1/50",
     .help = "exposure time, 1/50 or 0.02, for lights in lx, cd and nits; the f-number is the lens's", .scene = true,
     .check = parses<parse_shutter>},
    {.name = "colour", .group = "Lights", .unit = "COLOUR", .fallback = "D65",
     .help = "D65, A, E, a temperature such as 3200K, led, sodium, sodium-low, fluorescent, fluorescent-narrow, a "
             "file of wavelengths and powers, or R,G,B", .scene = true, .check = parses<parse_light_colour>},
    {.name = "light-distance", .group = "Lights", .unit = "DISTANCE", .fallback = "inf",
     .help = "of the lights from the first surface: 500 (mm), 2m, inf; nearer than the focus their flare changes, too",
     .scene = true, .check = parses<parse_distance_mm>},
    {.name = "light-size", .group = "Lights", .kind = Kind::Real, .unit = "deg", .minimum = 0, .maximum = 90,
     .fallback = "0", .help = "lights are discs so many degrees across, 0.53 for the sun; 0: points", .scene = true},

    {.name = "size", .group = "Frame", .unit = "WxH", .fallback = "1920x1080", .help = "size of the picture in pixels",
     .scene = true, .check = parses<parse_size>},
    {.name = "hfov", .group = "Frame", .kind = Kind::Real, .unit = "deg", .minimum = 0.01, .maximum = 175,
     .help = "horizontal field of view of the whole frame (default: the frame on the lens's sensor)", .scene = true},
    {.name = "pixel-aspect", .group = "Frame", .kind = Kind::Real, .minimum = 0.1, .maximum = 10,
     .help = "width over height of the picture's pixels as it is shown, 2 for many anamorphic plates (default: as the "
             "file says; of a rendered frame, square on the sensor)", .scene = true},

    {.name = "method", .group = "Rendering", .unit = "METHOD", .fallback = "adaptive",
     .help = "adaptive, bundle (hullin2011), tiled (bodonyi2023) or reference (exact and slow)", .check = check_method},
    {.name = "device", .group = "Rendering", .kind = Kind::Choice, .unit = "DEVICE", .fallback = "cpu",
     .help = "what computes: cpu", .choices = {"cpu"}, .scene = true},
    {.name = "wavelengths", .group = "Rendering", .unit = "N", .fallback = "auto",
     .help = "bands of the visible spectrum, 1 to 1024; auto: as many as each ghost's dispersion and coatings ask for",
     .check = parses<parse_wavelengths>},
    {.name = "colour-space", .group = "Rendering", .kind = Kind::Choice, .unit = "SPACE",
     .help = "linear working space: rec709 or acescg (default: the picture's, else rec709)",
     .choices = {"rec709", "acescg"}},
    {.name = "ghosts", .group = "Rendering", .kind = Kind::Choice, .unit = "SCOPE", .fallback = "all",
     .help = "all: every pair of surfaces; one-side: both reflections on one side of the stop, as in the papers",
     .choices = {"one-side", "all"}},
    {.name = "reflections", .group = "Rendering", .kind = Kind::Choice, .unit = "N", .fallback = "2",
     .help = "2, or 4: ghosts of four reflections besides, very many and very dim", .choices = {"2", "4"}},
    {.name = "select", .group = "Rendering", .unit = "CHOICE", .fallback = "all",
     .help = "all, brightest:N, flux:PERCENT (leave out the weakest that carry so much), surface:K, list:2-5,3-7",
     .check = parses<parse_selection>},
    {.name = "ghost", .group = "Rendering", .unit = "I-J|K:gain=G,colour=R,G,B,offset=X,Y",
     .help = "one ghost by its surfaces (2-5), or all that reflect at one (5): times a gain, a colour, set off to the "
             "right and up by shares of the frame's height; may be repeated",
     .repeats = true, .check = parses<parse_ghost_adjustment>},
    {.name = "ghost-gain", .group = "Rendering", .kind = Kind::Real, .minimum = 0, .maximum = kBig, .fallback = "1",
     .help = "all ghosts times so much; 1 is physically right"},
    {.name = "ghost-edge-gain", .group = "Rendering", .kind = Kind::Real, .minimum = 0, .maximum = kBig,
     .fallback = "1", .help = "ghosts of a light at the frame's corner times so much, evenly from 1 in the middle"},
    {.name = "ghost-ramp", .group = "Rendering", .unit = "PLACE:R,G,B/...",
     .help = "colours that ghosts are multiplied by over where they lie: 1 at the light's image, 0 in the middle, -1 "
             "opposite",
     .check = parses<parse_ghost_ramp>},
    {.name = "ghost-scatter", .group = "Rendering", .kind = Kind::Real, .minimum = 0, .maximum = 10, .fallback = "0",
     .help = "each ghost is set off by its own random way, RMS in the frame's height (hullin2011: 'imperfect symmetry')"},
    {.name = "ghost-seed", .group = "Rendering", .kind = Kind::Integer, .minimum = 0, .maximum = 1000000000,
     .fallback = "0", .help = "which of these"},
    {.name = "grid", .group = "Rendering", .kind = Kind::Integer, .minimum = 4, .maximum = 512, .fallback = "256",
     .help = "bundle, tiled: rays along each side of a ghost's grid"},
    {.name = "scale-grid", .group = "Rendering", .kind = Kind::Switch,
     .help = "bundle, tiled: fewer rays for small ghosts (bodonyi2023 eq. 13)"},
    {.name = "scale-grid-sigma", .group = "Rendering", .kind = Kind::Real, .minimum = 0, .maximum = 1e6, .fallback = "1",
     .help = "with --scale-grid: its sigma, by which a ghost's share of the sensor is multiplied"},
    {.name = "scale-grid-phi", .group = "Rendering", .kind = Kind::Real, .minimum = 0, .maximum = 4, .fallback = "0.5",
     .help = "with --scale-grid: its phi, the power that this is raised to"},
    {.name = "grid-levels", .group = "Rendering", .kind = Kind::Switch,
     .help = "bundle: instead of --grid one of 16 to 512 for each ghost, by how evenly its cells land"},
    {.name = "mirror", .group = "Rendering", .kind = Kind::Switch,
     .help = "bundle: trace half of each grid and mirror it at the light's meridian"},
    {.name = "pupil-table", .group = "Rendering", .kind = Kind::Switch,
     .help = "bundle: where ghosts' rays enter from a table over the light's angle, made first, not from a search"},
    {.name = "spectral-filter", .group = "Rendering", .kind = Kind::Switch,
     .help = "bundle: up to 7 wavelengths, each blurred towards the next to bridge the gaps"},
    {.name = "flat-shading", .group = "Rendering", .kind = Kind::Switch,
     .help = "bundle: level cells instead of irradiance that follows the grid's vertices"},
    {.name = "anisotropic", .group = "Rendering", .kind = Kind::Choice, .unit = "HOW", .fallback = "exact",
     .help = "bundle: ghosts squeezed into lines: exact, high-resolution (4 x 4 pixels for one), points",
     .choices = {"exact", "high-resolution", "points"}},  // in enum order
    {.name = "merge-steps", .group = "Rendering", .kind = Kind::Integer, .minimum = 0, .maximum = 9, .fallback = "4",
     .help = "tiled: how often 2 x 2 cells of the grid may become one where it is flat; 0: never"},
    {.name = "merge-threshold", .group = "Rendering", .kind = Kind::Real, .minimum = 0, .maximum = 1e6,
     .fallback = "0.001", .help = "tiled: largest bend of cells that become one, in half frame widths; 0.1: heavy"},
    {.name = "tile", .group = "Rendering", .kind = Kind::Integer, .unit = "px", .minimum = 1, .maximum = 4096,
     .fallback = "8", .help = "tiled: side of the screen's tiles"},
    {.name = "coarse-tile", .group = "Rendering", .kind = Kind::Integer, .unit = "px", .minimum = 0, .maximum = 4096,
     .fallback = "128", .help = "tiled: side of the tiles listed first, a multiple of --tile; 0: none"},
    {.name = "interpolation", .group = "Rendering", .kind = Kind::Choice, .unit = "METHOD", .fallback = "loop-derose",
     .help = "tiled: within a cell: triangle, homogeneous-triangle, mean-value, wachspress, loop-derose",
     .choices = {"triangle", "homogeneous-triangle", "mean-value", "wachspress", "loop-derose"}},  // in enum order
    {.name = "error", .group = "Rendering", .unit = "E|PRESET", .fallback = "standard",
     .help = "adaptive: RMS error over the flare's peak, 0.0001 to 0.1; preview 0.01, standard 0.003, final 0.001",
     .check = parses<parse_error_bound>},
    {.name = "density", .group = "Rendering", .kind = Kind::Real, .minimum = 0.05, .maximum = 16, .fallback = "1",
     .help = "reference: 2 halves the cells"},
    {.name = "starburst", .group = "Rendering", .kind = Kind::Switch,
     .help = "add each light's own image as diffraction at the iris spreads it"},
    {.name = "starburst-gain", .group = "Rendering", .kind = Kind::Real, .minimum = 0, .maximum = kBig, .fallback = "1",
     .help = "starburst times so much; 1 is physically right"},
    {.name = "glare", .group = "Rendering", .kind = Kind::Real, .minimum = 0, .maximum = 1, .fallback = "0",
     .help = "veiling glare: share of each light that the lens scatters about its image; good lenses: 0.005 to 0.03"},
    {.name = "glare-width", .group = "Rendering", .kind = Kind::Real, .unit = "deg", .minimum = 0.001, .maximum = 80,
     .fallback = "1", .help = "angle from the light within which glare is flat; beyond, it falls as the cube"},
    {.name = "ringing", .group = "Rendering", .kind = Kind::Choice, .unit = "HOW", .fallback = "none",
     .help = "diffraction fringes along ghosts' rims: fresnel: each ghost's own, as far as it is out of focus; hullin: one pattern for "
             "all (hullin2011)",
     .choices = {"none", "fresnel", "hullin"}},  // in enum order
    {.name = "ringing-alpha", .group = "Rendering", .kind = Kind::Real, .minimum = 0, .maximum = 1,
     .help = "order of hullin's ringing, 0: none (default: 0.15 (wavelength / 400 nm) (f-number / 18))"},
    {.name = "threads", .group = "Rendering", .kind = Kind::Integer, .minimum = 0, .maximum = 1024, .fallback = "0",
     .help = "threads; 0: all cores. The picture does not depend on it", .scene = true},

    {.name = "detect", .group = "Finding lights", .kind = Kind::Switch, .fallback = "on",
     .help = "bright areas of the picture are lights; off: only those given with --light and --light-at", .scene = true},
    {.name = "region", .group = "Finding lights", .unit = "U,V,U,V",
     .help = "find lights only between these corners, 0,0 top left, 1,1 bottom right, and there dimmer ones too; may be "
             "repeated",
     .repeats = true, .scene = true, .check = parses<parse_region>},
    {.name = "threshold", .group = "Finding lights", .kind = Kind::Real, .minimum = 0, .maximum = kBig,
     .help = "level above which a pixel belongs to a light (default: from the picture)", .scene = true},
    {.name = "softness", .group = "Finding lights", .kind = Kind::Real, .minimum = 0, .maximum = 1000,
     .fallback = "0.25", .help = "a pixel counts in full at threshold x (1 + softness)", .scene = true},
    {.name = "max-lights", .group = "Finding lights", .kind = Kind::Integer, .minimum = 1, .maximum = 100000,
     .fallback = "8", .help = "more are merged into the nearest of these, without losing flux", .scene = true},
    {.name = "min-pixels", .group = "Finding lights", .kind = Kind::Integer, .minimum = 1, .maximum = 1000000000,
     .fallback = "1", .help = "smaller areas, such as hot pixels, are no lights", .scene = true},
    {.name = "max-value", .group = "Finding lights", .kind = Kind::Real, .minimum = 1e-6, .maximum = 1e10,
     .fallback = "1e10", .help = "brighter pixels count as of this level, in their colour: hot pixels, a sun too bright",
     .scene = true},
    {.name = "light-shape", .group = "Finding lights", .kind = Kind::Switch, .fallback = "on",
     .help = "lights have the shape of their pixels, for ghosts and starburst; off: points where their middles are",
     .scene = true},
    {.name = "spectrum", .group = "Finding lights", .unit = "SPECTRUM", .fallback = "D65",
     .help = "spectrum within each channel of the picture's lights: D65, A, E, 3200K, led, sodium, ... as --colour",
     .scene = true, .check = check_spectrum},
    {.name = "gain", .group = "Finding lights", .kind = Kind::Real, .minimum = 0, .maximum = kBig, .fallback = "1",
     .help = "flare times so much; 1 is physically right"},
    {.name = "stops", .group = "Finding lights", .kind = Kind::Real, .unit = "STOPS", .minimum = -40, .maximum = 40,
     .fallback = "0", .help = "flare so many stops brighter, besides --gain; 0 is physically right"},

    {.name = "exposure", .group = "Output", .unit = "STOPS|auto",
     .help = "brightness of PNG pictures to look at; auto: by the brightest parts",
     .scene = true, .check = check_exposure},
    {.name = "wavelength", .group = "Lens", .kind = Kind::Real, .unit = "nm", .minimum = 300, .maximum = 1100,
     .help = "wavelength (default: the lens's design wavelength)", .scene = true},
};
// clang-format on

}  // namespace

std::span<const Parameter> all_parameters() { return kTable; }

}  // namespace contrejour::params
