// SPDX-License-Identifier: Apache-2.0
// Properties of a ghost's map from the entrance plane to the sensor, measured on a coarse grid.
#pragma once

#include "ghosts/ray_grid.h"

namespace contrejour::inline internal::bundle {

inline constexpr int kProbeSide = 33;  // rays a side: enough for every property here

struct MapFigures {
  // The variance of the signed cell areas on the sensor, over the square of their mean size; folded cells have negative
  // areas.
  double area_variance = 0;
  // The fraction of cells with an open corner; pi / 4 where a round pupil fills its rectangle.
  double open_fraction = 0;
  // The ratio of the largest to the smallest stretch of an open cell, at its maximum over the cells.
  double anisotropy = 1;
  // Where the open rays meet the sensor, weighted by transmittance and by the distance from the opening's edge. Weight
  // 0: there are none.
  double weight = 0;
  Vec2 centre_mm, spread_mm;  // mean and standard deviation
};

[[nodiscard]] MapFigures measure_map(const RayGrid& probe);

// hullin2011 4.2, adaptive resolution: one of six grids, 16 to 512 rays a side, by the variance of cell areas.
// Differs: the paper gives no thresholds. These keep a ghost's error about 60 dB below its own peak; a pupil that fills
// little of its rectangle gets as many rays as one that fills it.
[[nodiscard]] int grid_level(const MapFigures& figures);

// hullin2011 7.2: "very anisotropic ghosts (min/max ratio > 1000)".
[[nodiscard]] bool is_very_anisotropic(const MapFigures& figures);

}  // namespace contrejour::inline internal::bundle
