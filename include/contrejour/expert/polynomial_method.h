// SPDX-License-Identifier: Apache-2.0
// The options of the method `polynomial`, which draws ghosts as `adaptive` does, with rays that are evaluated from a
// fit (polynomial.h) where the fit accepts a ghost, and traced elsewhere. Thread-safety: plain values.
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "contrejour/export.h"

namespace contrejour {

struct LensPolynomialRange;
struct LensPolynomials;

struct CONTREJOUR_API PolynomialRenderOptions {
  static constexpr std::string_view kMethod = "polynomial";
  double error = 0.003;  // limit of the RMS error, relative to the frame's peak, without the fit's; 1e-4 to 0.1
  // The fit, or that of a range of zoom or focus, of which the lens's state is taken, or else a file of either. With
  // none of them, the ghosts that a frame needs are fitted, which takes about a tenth of a second each; a Renderer
  // keeps them for its next frames. A fit of another lens is refused.
  std::shared_ptr<const LensPolynomials> fit = nullptr;
  std::shared_ptr<const LensPolynomialRange> range = nullptr;
  std::filesystem::path file = {};
  // To compare with: ghosts are drawn by points^2 random points for each light and wavelength, one in each cell of a
  // grid over the ghost's opening, in place of cells whose number follows from `error`. 0: cells. Ringing, dirt and an
  // iris with half-tones are refused (Unsupported).
  static constexpr int kMostPoints = 8192;
  int points = 0;
};

}  // namespace contrejour
