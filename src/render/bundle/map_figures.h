// What a coarse grid tells of a ghost's map from the entrance plane to the sensor.
#pragma once

#include "ghosts/ray_grid.h"

namespace contrejour::bundle {

inline constexpr int kProbeSide = 33;  // rays a side: enough for every figure here

struct MapFigures {
  // Of the signed cell areas on the sensor, over the square of their mean size; folds count as areas below zero.
  double area_variance = 0;
  // Cells with an open corner, as a share of all; pi / 4 where a round pupil fills its rectangle.
  double open_share = 0;
  // The largest stretch of an open cell over its smallest, at the worst of them.
  double anisotropy = 1;
  // Where the open rays land, weighted by their transmission and towards the middle of the opening. None: weight 0.
  double weight = 0;
  Vec2 centre_mm, spread_mm;  // mean and standard deviation
};

[[nodiscard]] MapFigures measure_map(const RayGrid& probe);

// hullin2011 4.2, adaptive resolution: one of six grids, 16 to 512 rays a side, by the variance of cell areas.
// Differs: the paper gives no thresholds. These keep a ghost within about 60 dB of its own peak; a pupil that
// fills little of its rectangle gets as many rays as one that fills it.
[[nodiscard]] int grid_level(const MapFigures& figures);

// hullin2011 7.2: "very anisotropic ghosts (min/max ratio > 1000)".
[[nodiscard]] bool is_very_anisotropic(const MapFigures& figures);

}  // namespace contrejour::bundle
