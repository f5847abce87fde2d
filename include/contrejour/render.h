// Rendering: lens state, lights and settings in, flare and statistics out. One contract, several methods.
// The image holds what the flare adds to the photograph, in the lights' own units (docs/physics/radiometry.md):
// a light whose image sums to V makes a ghost pixel of V * E_ghost * A_pixel / Phi. It does not hold the
// lights' direct images, unless settings.starburst is on. Channels may be slightly negative where a ghost's colour
// lies outside the RGB gamut.
// Errors: InvalidArgument, Cancelled. Same result for any thread count. Thread-safety: pure functions.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/frame.h"
#include "contrejour/ghost.h"
#include "contrejour/image.h"
#include "contrejour/lens.h"
#include "contrejour/light.h"

namespace contrejour {

// What hullin2011 4.2 and 4.3 do to be quicker or better; `bundle` only.
struct BundleOptions {
  bool smooth_shading = true;      // irradiance averaged to the vertices, linear over a cell; off: level cells
  bool grid_levels = false;        // instead of `grid`: one of six, 16 to 512, by the variance of the cells' areas
  bool mirror_symmetry = false;    // half the grid is traced, the other half mirrored at the light's meridian
  bool precomputed_bounds = false; // pupil bounds from a table over field angles, made first, instead of a search
  bool spectral_filter = false;    // few bands, each blurred along the way to its neighbours to bridge the gap
  enum class Anisotropic { Exact, HighResolution, Points } anisotropic = Anisotropic::Exact;
};

// bodonyi2023; `tiled` only.
struct TiledOptions {
  int merge_steps = 4;
  double merge_threshold = 0.001;  // gamma of eq. 12; light 0.001, heavy 0.1
  int dense_tile = 8;              // pixels a side; must divide coarse_tile
  int coarse_tile = 128;           // 0: none
  enum class Interpolation {
    Triangle,
    HomogeneousTriangle,
    MeanValue,
    Wachspress,
    LoopDeRose
  } interpolation = Interpolation::LoopDeRose;
};

// Each light's own image as diffraction spreads it (docs/physics/diffraction.md), added after the ghosts by every
// method alike: a light that gets through in full sums to its value over an unlimited picture.
struct StarburstOptions {
  bool on = false;
  double gain = 1.0;  // 0 and more; 1 is physically right
  // Where a photograph holds the lights' own images already: a share from 0 to 1 a pixel that is left out of starburst
  // and glare, one channel, as large as the frame. Null: nothing is left out.
  std::shared_ptr<const Image> left_out = nullptr;
  // Whose images are drawn, with starburst and glare, where these are not the lights that the ghosts are of: lights
  // that were merged for the ghosts' sake keep their images apart. Null: the same.
  std::shared_ptr<const std::vector<Light>> lights = nullptr;
};

// What polish, dust and edges scatter about each light's own image: over angles theta as (1 + (theta / width)^2)^-1.5.
struct GlareOptions {
  double share = 0.0;  // of the light's value, 0 to 1, over an unlimited picture; 0: none
  double width_rad = 0.0175;
};

// What an artist bends about a ghost. Gains are 0 and more, 1 is physically right; so are colours, per channel.
struct GhostAdjustment {
  Ghost ghost;
  double gain = 1.0;
  Rgb colour{1, 1, 1};
  Vec2 offset{};  // in the picture, to the right and up, of the frame's height
  int surface = 0;  // 1-based, in place of a ghost: all ghosts that reflect there
};

// A colour that ghosts are multiplied by, over where they lie: 1 at the light's image, 0 in the frame's middle, -1
// opposite the light (first order: through the middle of the stop). Between stops it goes over evenly, beyond the first
// and the last it stays.
struct GhostRampStop {
  double place = 0.0;
  Rgb colour{1, 1, 1};
};

struct GhostOptions {
  double gain = 1.0;  // of all ghosts
  double edge_gain = 1.0;  // and this when the light is at the frame's corner, in proportion nearer to the middle
  std::vector<GhostAdjustment> adjustments;  // gains and colours of one ghost multiply, its offsets add up
  std::vector<GhostRampStop> ramp;  // places rising
  // hullin2011 4.2, imperfect symmetry: each ghost is set off by its own random way, normally distributed with this
  // root mean square, of the frame's height.
  double scatter = 0.0;
  std::uint32_t scatter_seed = 0;
};

// What diffraction at the iris does to the ghosts' rims (docs/physics/diffraction.md).
enum class RingingMode {
  None,
  Fresnel,  // each ghost's own fringes, from how far out of focus it is
  Hullin,  // hullin2011 eq. 5: one pattern for all ghosts, by experience
};
class RingingPatterns;
struct RingingOptions {
  RingingMode mode = RingingMode::None;
  std::optional<double> alpha = std::nullopt;  // Hullin: the order; default: hullin_order()
  std::shared_ptr<RingingPatterns> patterns = nullptr;  // ringing.h: kept from frame to frame, if given
};

inline constexpr int kWavelengthsByNeed = 0;

struct RenderSettings {
  Frame frame;
  GhostScope scope = GhostScope::All;
  Reflections reflections = Reflections::Two;
  GhostSelection selection = SelectAll{};
  // Bands of the visible spectrum; or by need: as many for each ghost as its dispersion and the coatings ask for, 32 at
  // most (docs/physics/colour.md). The light of each channel is that of 96 bands to 2 per cent by any method.
  int wavelengths = kWavelengthsByNeed;
  ColourSpace colour_space = ColourSpace::Rec709;
  std::vector<double> lambda_nm;  // instead of bands: these wavelengths, equal weights, for tests and tables

  int grid = 256;  // `bundle`, `tiled`: rays along each side of a ghost's grid, 4 to 512
  bool scale_grid = false;  // `bundle`, `tiled`: fewer rays for small ghosts, bodonyi2023 eq. 13
  double scale_grid_sigma = 1.0;  // its sigma and phi: the share of the sensor times sigma, to the power of phi; 0 and
  double scale_grid_phi = 0.5;  // more, up to 1e6 and 4
  BundleOptions bundle;
  TiledOptions tiled;
  double error = 0.003;  // `adaptive`: RMS error to stay below, over the frame's peak; 1e-4 to 0.1
  double reference_density = 1;  // `reference`: 2 halves the cells
  StarburstOptions starburst;
  GlareOptions glare;
  GhostOptions ghosts;
  RingingOptions ringing;
};

struct RenderStatistics {
  std::string method;
  std::string device = "cpu";
  std::vector<std::pair<std::string, double>> time_ms;  // by phase, "total" last
  std::uint64_t rays = 0;
  std::uint64_t surface_hits = 0;
  std::uint64_t primitives = 0;
  int ghosts_rendered = 0;
  // Share of the flare's flux that selection left out; none where it did not go by flux (a list, a surface), since
  // measuring every ghost may take longer than rendering the chosen ones.
  std::optional<double> ghosts_skipped_flux;
  std::uint64_t peak_memory_bytes = 0;

  // `tiled`; `primitives` counts them before merging.
  std::uint64_t primitives_merged = 0;  // what merging leaves
  std::uint64_t tile_indices = 0;  // entries of all dense tiles' lists
  std::uint64_t primitive_bytes = 0;  // of the primitives held at once
  std::uint64_t tile_list_bytes = 0;  // of the dense tiles' lists held at once
};

struct Flare {
  Image image;  // RGB of settings.frame
  RenderStatistics statistics;
};

// Properties of a method, for code that would otherwise compare its name.
struct MethodTraits {
  bool is_exact = false;  // converges to the true flare as its density rises: the others are judged by it
  bool is_slow = false;  // takes minutes where others take seconds
  bool integrates_pixels = true;  // a pixel holds all the light that falls on it; false: it is sampled at its middle
  bool spends_error =
      false;  // spreads the error that it is allowed over the frame: a ghost's own differs from frame to frame
};

[[nodiscard]] std::vector<std::string_view> render_methods();  // the default first
[[nodiscard]] std::optional<MethodTraits> method_traits(std::string_view method);  // none: there is no such method

[[nodiscard]] Result<Flare> render(std::string_view method, const LensState& lens, std::span<const Light> lights,
                                   const RenderSettings& settings, const Context& context = {});

}  // namespace contrejour
