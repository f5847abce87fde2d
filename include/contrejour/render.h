// Rendering: lens state, lights and settings in, flare and statistics out. One contract, several methods.
// The image holds what the flare adds to the photograph, in the lights' own units (docs/physics/radiometry.md):
// a light whose image sums to V makes a ghost pixel of V * E_ghost * A_pixel / Phi. It does not hold the
// lights' direct images. Channels may be slightly negative where a ghost's colour lies outside the RGB gamut.
// Errors: InvalidArgument, Cancelled. Same result for any thread count. Thread-safety: pure functions.
#pragma once

#include <cstdint>
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

struct RenderSettings {
  Frame frame;
  GhostScope scope = GhostScope::OneSideOfStop;
  GhostSelection selection = SelectAll{};
  int wavelengths = 3;
  ColourSpace colour_space = ColourSpace::Rec709;
  std::vector<double> lambda_nm;  // instead of bands: these wavelengths, equal weights, for tests and tables

  int grid = 256;                // `bundle`: rays along each side of a ghost's grid, 16 to 512
  bool scale_grid = false;       // `bundle`: fewer rays for small ghosts, bodonyi2023 eq. 13
  double reference_density = 1;  // `reference`: 2 halves the cells
};

struct RenderStatistics {
  std::string method;
  std::string device = "cpu";
  std::vector<std::pair<std::string, double>> time_ms;  // by phase, "total" last
  std::uint64_t rays = 0;
  std::uint64_t surface_hits = 0;
  std::uint64_t primitives = 0;
  int ghosts_rendered = 0;
  double ghosts_skipped_flux = 0;  // share of the flare's flux that selection left out
  std::uint64_t peak_memory_bytes = 0;
};

struct Flare {
  Image image;  // RGB of settings.frame
  RenderStatistics statistics;
};

[[nodiscard]] std::vector<std::string_view> render_methods();

[[nodiscard]] Result<Flare> render(std::string_view method, const LensState& lens, std::span<const Light> lights,
                                   const RenderSettings& settings, const Context& context = {});

}  // namespace contrejour
