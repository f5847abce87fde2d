// SPDX-License-Identifier: Apache-2.0
// Rays of a lens's ghost in the light's tangents and the point of the entrance plane, for published fits of pictures.
#pragma once

#include <array>
#include <optional>

#include "contrejour/expert/published_fits.h"
#include "contrejour/expert/published_pictures.h"
#include "contrejour/expert/trace.h"
#include "ghosts/ray_grid.h"
#include "polynomial/published/seeded_random.h"

namespace contrejour::inline internal::polynomial {

class GhostToFit {
 public:
  GhostToFit(const LensState& lens, const Ghost& ghost, double lambda_nm)
      : lens_(lens), path_(ghost_path(lens, ghost, lambda_nm)) {}

  // The rectangle of the plane z = 0 that holds the rays of a light that nothing blocks; none without any.
  [[nodiscard]] std::optional<Rectangle> opening(Vec2 light) const;

  [[nodiscard]] TracedRay trace_at(Vec2 light, Vec2 entrance_mm) const;
  [[nodiscard]] bool passes(const TracedRay& ray) const;

  // The sensor's x and y, the stop's x and y, and the transmittance, each with the same inputs: the light's tangents
  // about `light` over the half range, and points of the window over its half size. Empty without enough rays that
  // nearly pass.
  [[nodiscard]] std::array<published::Samples, 5> samples(const published::PictureOptions& options, Vec2 light) const;

  // The inputs that stand for an entrance point: their middle and scale are the same for all ghosts, as published.
  [[nodiscard]] Vec2 normalised(Vec2 entrance_mm) const;

 private:
  const LensState& lens_;
  OpticalPath path_;
};

}  // namespace contrejour::inline internal::polynomial
