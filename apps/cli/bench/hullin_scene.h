// SPDX-License-Identifier: Apache-2.0
// The scenes and qualities of hullin2011's figures, and the rows that their renders make.
#pragma once

#include <string>
#include <vector>

#include "cli/bench/hullin.h"
#include "contrejour/lens.h"
#include "contrejour/light.h"
#include "contrejour/render.h"

namespace contrejour::cli {

inline constexpr double kFourStops = 4.0;  // as a factor of f-numbers

// A lens with the light of all figures.
struct HullinScene {
  LensState lens;
  Light light;
  BundleOptions bundle;
  FrameSettings settings;
};

// The lens at its maximum aperture, stopped down by this factor on its f-number.
[[nodiscard]] Result<HullinScene> hullin_scene(const HullinSystem& system, double f_number_factor,
                                               const params::Values& values);

// The ghosts in increasing order of the flux of their light at one wavelength.
[[nodiscard]] std::vector<Ghost> weakest_first(const HullinScene& scene);

// All ghosts but this fraction of the weakest.
[[nodiscard]] SelectList without_weakest(const std::vector<Ghost>& weakest_first, double fraction);

// A method's options, and the settings of its frame.
struct HullinQuality {
  MethodOptions method;
  FrameSettings settings;
};
// 7 bands and filtering across them; the paper's supersampling is not needed where pixels are covered exactly.
[[nodiscard]] HullinQuality high_quality(const HullinScene& scene);
// RGB, no filtering, without the weakest 40 per cent of the ghosts.
[[nodiscard]] HullinQuality normal_quality(const HullinScene& scene, const std::vector<Ghost>& ghosts);
// All ghosts with this number of rays a side.
[[nodiscard]] HullinQuality with_grid(const HullinScene& scene, int rays);

struct HullinRender {
  Image image;
  double ms = 0;  // of the fastest run
  int ghosts = 0;
};
// Renders several times. Errors: those of render().
[[nodiscard]] Result<HullinRender> render_runs(const HullinScene& scene, const HullinQuality& quality,
                                               const HullinRunning& running);

// nullopt: the images are equal.
[[nodiscard]] std::optional<double> hullin_psnr_db(const Image& truth, const Image& image);

[[nodiscard]] HullinRow row_of(const char* figure, const HullinSystem& system, const HullinScene& scene,
                               std::string what, const HullinRender& rendered);

// Passes the row's picture on to running.show, if that is set.
[[nodiscard]] Result<void> show_picture(const HullinRunning& running, const HullinRow& row, const Image& image);

// The measurement of coarse grids (hullin_grids.cpp).
[[nodiscard]] Result<std::vector<HullinRow>> measure_grids(const HullinSystem& system, const params::Values& values,
                                                           const HullinRunning& running);

}  // namespace contrejour::cli
