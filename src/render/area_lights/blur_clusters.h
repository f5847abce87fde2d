// SPDX-License-Identifier: Apache-2.0
// Groups the ghosts of a piece of a light that are blurred alike: each group is drawn once, with as few pixels as the
// blur allows.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "contrejour/frame.h"
#include "render/area_lights/ghost_blur.h"

namespace contrejour::inline internal::area {

// A ghost of a piece of a light, with the coarsest level of the image pyramid in which it may be drawn
// (image_pyramid.h); a negative level is that of a window of its own (fine_window.h).
struct PieceGhost {
  const GhostBlur* blur = nullptr;
  int level = 0;
  std::size_t spot = 0;  // if negative: ghosts of one spot, in pieces of one light, share that window
  double overlapping = 1.0;  // ghosts of other pieces of the same light, and this one, that overlap: errors add up
};

struct BlurCluster {
  bool is_sharp = false;  // its blur is not visible: it is drawn without
  int level = 0;          // of the image pyramid
  LinearMap px_from_tangents;  // in pixels of that level
  std::size_t seed = 0;  // the given ghost whose blur all have
  std::vector<std::size_t> ghosts;  // indices of the given ghosts, ascending
  std::vector<double> light_fractions;  // one for each of `ghosts`: the part of its light in this cluster
};

struct BlurClusters {
  std::vector<BlurCluster> clusters;
  double squares = 0.0;  // squared error of sharing, summed over the frame, in squares of the peak
};

// allowed_squares: the error of a ghost that may save an image as costly as one at the frame's resolution.
[[nodiscard]] BlurClusters blur_clusters(std::span<const PieceGhost> ghosts, const LightPiece& piece,
                                         const Frame& frame, double peak, double allowed_squares);

// The mean of two choices of clusters for the same ghosts, with this part of the second: a ghost that they assign to
// different clusters has a part of its light in each. So ghosts fade from one choice into the other as `part` changes.
[[nodiscard]] BlurClusters mean_of(const BlurClusters& first, const BlurClusters& second, double part);

}  // namespace contrejour::inline internal::area
