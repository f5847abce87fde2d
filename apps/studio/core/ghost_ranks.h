// SPDX-License-Identifier: Apache-2.0
// How much light each ghost of a lens has in the picture, for lights at several places: another ghost is the brightest
// when the light is elsewhere. Drafts that draw few ghosts choose them by it while a light is dragged, when there is no
// time to measure them. A radius is the distance of a light's image from the middle of the frame over half of the
// frame's diagonal. Thread-safety: plain values, pure functions; KeptRanks by one thread.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/ghost_id.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/ghost_figures.h"
#include "contrejour/lens.h"

namespace contrejour::studio {

struct GhostRanks {
  std::vector<double> radii;  // rising
  std::vector<Ghost> ghosts;  // all of the lens
  std::vector<std::vector<double>> light;  // by radius, then ghost
};

// All ghosts, the brightest first, by their light for lights at these radii together: linear between two of the ranks'
// radii, in steps of a quarter, so that the order seldom changes while a light moves. Accuracy: on five lenses the
// first eight have 0.96 to 1.00 of the light of the true first eight in the mean, 0.79 at least; those of another place
// in the field have 0.2 to 0.8 (docs/studio.md).
[[nodiscard]] std::vector<Ghost> brightest_at(const GhostRanks& ranks, std::span<const double> radii);

[[nodiscard]] double radius_of(Vec2 uv, Vec2 frame_px);

// The flux of its part inside the frame.
[[nodiscard]] double light_in_frame(const GhostFigures& ghost, Vec2 frame_px);

inline constexpr std::array<double, 6> kRankedRadii = {0.1, 0.35, 0.6, 0.85, 1.1, 1.5};

// The ranks of a lens with a user's values, kept until these are others.
class KeptRanks {
 public:
  // Null unless they are there already.
  [[nodiscard]] std::shared_ptr<const GhostRanks> find(const params::Values& values, const LensState& lens);
  // Measures lights on the frame's diagonal, where most ghosts lie in the frame, with few wavelengths. What was
  // measured before it is cancelled is kept for the next call. Null: cancelled, or the values have no picture.
  [[nodiscard]] std::shared_ptr<const GhostRanks> measure(const params::Values& values, const LensState& lens,
                                                          const Context& context);

 private:
  void forget_others(const params::Values& values, const LensState& lens);

  std::string key_;
  std::vector<SurfaceState> surfaces_;
  GhostRanks measured_;  // at the first of kRankedRadii
  std::shared_ptr<const GhostRanks> all_;
};

}  // namespace contrejour::studio
