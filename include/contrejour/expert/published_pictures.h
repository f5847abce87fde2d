// SPDX-License-Identifier: Apache-2.0
// Pictures of ghosts drawn by splatting the points of rays, as the thesis's dense rendering draws them (sabatschus2022
// 2.2), from traced rays and from published polynomials (published_fits.h), with the faults of its code one by one.
// docs/physics/polynomial-published.md shows them. One wavelength, one channel; values are fluxes of pixels over the
// light's irradiance in mm^2, those of the thesis's system in its units. Thread-safety: pure functions.
#pragma once

#include <cstdint>

#include "contrejour/context.h"
#include "contrejour/expert/published_samples.h"
#include "contrejour/expert/vec.h"
#include "contrejour/export.h"
#include "contrejour/image.h"
#include "contrejour/lens.h"

namespace contrejour::published {

struct PictureFaults {
  // The polynomials of x and y of all ghosts are collected in the order in which threads finish them, and read by their
  // position: a random order, by the seed.
  bool output_order = false;
  // The fit numbers all pairs of surfaces with the stop, the renderer those without it.
  bool stop_counted = false;
  // The renderer reads at a number that counts from 1.
  bool next_ghost = false;
  // The point on the stop is no output: it stays 0, and the stop never blocks.
  bool no_stop_position = false;
  // Fitted for a light about the axis, and drawn for the picture's light.
  bool extrapolated = false;
};

struct PictureOptions {
  Vec2 light{0.1, 0.06};  // tangents
  double half_range = 0.02;  // of the light's tangents about the one that is fitted for
  int width = 240, height = 160;
  int points = 400;  // squared: of each ghost, one somewhere in each cell of a grid
  bool random_points = false;  // all of them anywhere instead
  int samples = 1200;  // of each ghost's fit
  int degree = 6;
  double lambda_nm = 550.0;
  std::uint64_t seed = 1;
  PictureFaults faults = {};
};

// The ghosts with both reflections on one side of the stop, from dense polynomials in the light's tangents and the
// point of the entrance plane. Errors: InvalidArgument for options out of range, Cancelled.
[[nodiscard]] CONTREJOUR_API Result<Image> draw_fitted_ghosts(const LensState& lens, const PictureOptions& options,
                                                              const Context& context = {});

// The same from traced rays, without faults.
[[nodiscard]] CONTREJOUR_API Result<Image> draw_traced_ghosts(const LensState& lens, const PictureOptions& options,
                                                              const Context& context = {});

struct TwoLensesPicture {
  TwoLenses system;
  ElementPair ghost{0, 1};
  // The polynomials of x and y, of monomials; null: rays are traced. Nothing blocks the rays of polynomials.
  const Polynomial* x = nullptr;
  const Polynomial* y = nullptr;
  Vec2 light = {};  // over 0.5, from -1 to 1
  int size = 160;  // of the picture, in pixels
  double half_size = 2.0;  // of the picture
  int points = 600;  // squared
};

[[nodiscard]] CONTREJOUR_API Result<Image> draw_two_lenses(const TwoLensesPicture& picture,
                                                           const Context& context = {});

}  // namespace contrejour::published
