// SPDX-License-Identifier: Apache-2.0
// Edge waves of an opening with imperfect edges, whose slopes are normally distributed about those of the outline.
// Where the edges' heights exceed many wavelengths over the angle of diffraction, each piece diffracts along its own
// normal, so that the pattern of an exact outline is averaged over directions, which conserves its flux. This blurs the
// ends of fans; consecutive fans of exact edges are separated by a dark line, because each has a straight edge's
// fringes there. Accuracy: 1 per cent of that average. Source: docs/physics/diffraction.md.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "contrejour/context.h"
#include "diffraction/edge_waves.h"

namespace contrejour::inline internal {

class UnevenEdges {
 public:
  // slope_spread_rad: RMS. Less than kMinSpread_rad: the exact outline.
  UnevenEdges(const IrisOpening& opening, double slope_spread_rad, const Context& context);
  static constexpr double kMinSpread_rad = 0.005;

  // Everything that depends on the direction alone. The edges must outlive it.
  class Direction {
   public:
    // As EdgeWaves::Direction::power, averaged over the slopes too.
    [[nodiscard]] double power(double k) const;

   private:
    friend class UnevenEdges;
    std::optional<EdgeWaves::Direction> exact_;
    const float *here_ = nullptr, *next_ = nullptr;  // the table's rows of two directions
    double next_weight_ = 0;
  };

  [[nodiscard]] Direction along(double direction_rad, double window_rad) const;
  [[nodiscard]] std::vector<double> end_normals() const { return exact_.end_normals(); }

 private:
  EdgeWaves exact_;
  std::size_t directions_ = 0;  // of the table, over half a turn; none: the outline is exact
  std::vector<float> power_k3_;  // [direction * rows + row], rows by the logarithm of k
};

}  // namespace contrejour::inline internal
