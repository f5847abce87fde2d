// Edge waves of an opening whose edges are not exact: their slopes scatter about those of the outline, normally
// distributed. Where the edges' heights are many wavelengths over the angle of diffraction, each piece sends its light
// along its own normal, so that what an exact outline sends is averaged over directions, which keeps its flux. The ends
// of fans are smeared; between exact ones that follow one another there is a dark line, as each has a straight edge's
// fringes there. Accuracy: 1 per cent of that average. Source: docs/physics/diffraction.md.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "contrejour/context.h"
#include "diffraction/edge_waves.h"

namespace contrejour {

class UnevenEdges {
 public:
  // slope_spread_rad: RMS. Less than kLeastSpread_rad: the exact outline.
  UnevenEdges(const IrisOpening& opening, double slope_spread_rad, const Context& context);
  static constexpr double kLeastSpread_rad = 0.005;

  // All that depends on the direction only. The edges must outlive it.
  class Direction {
   public:
    // As EdgeWaves::Direction::power, averaged over the slopes too.
    [[nodiscard]] double power(double k) const;

   private:
    friend class UnevenEdges;
    std::optional<EdgeWaves::Direction> exact_;
    const float *here_ = nullptr, *next_ = nullptr;  // the table's rows of two directions
    double share_of_next_ = 0;
  };

  [[nodiscard]] Direction along(double direction_rad, double window_rad) const;
  [[nodiscard]] std::vector<double> end_normals() const { return exact_.end_normals(); }

 private:
  EdgeWaves exact_;
  std::size_t directions_ = 0;  // of the table, over half a turn; none: the outline is exact
  std::vector<float> power_k3_;  // [direction * rows + row], rows by the logarithm of k
};

}  // namespace contrejour
