// SPDX-License-Identifier: Apache-2.0
// Light scattered about a light's own image, which ghosts are fitted without. It moves with the light, as a ghost of
// speed 1 would, and has the same form at every station; ghosts of other speeds leave each of its places at some
// station. Its level over the light's changes with the angle, as vignetting makes the pupil smaller.
// Thread-safety: pure functions.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "contrejour/expert/vec.h"
#include "measure/fit/flare_problem.h"

namespace contrejour::inline internal {

// The halo's level at rising distances from the light; between them it is interpolated. It ends at 0, because a level
// that is the same everywhere cannot be told from a ghost larger than the picture.
struct HaloProfile {
  std::vector<double> radius_px;
  std::array<std::vector<double>, 3> level;

  // The level on the axis, and by how much it is multiplied for a light at s: 1 + change[0] s^2 + change[1] s^4.
  std::array<double, 2> change{};

  // Vignetting makes the pupil oblong, and the halo with it: at an angle phi from the direction away from the optical
  // centre, the level is multiplied by 1 + oblong s^2 cos(2 phi).
  double oblong = 0;

  [[nodiscard]] double at(double r_px, std::size_t channel) const;
  [[nodiscard]] double scale(double s) const;
};

struct HaloSettings {
  double masked_px = 0;  // about the light: not measured
  // Of a ring's pixels, and of the stations: ghosts only add light, so low ones are the halo. Where ghosts have been
  // subtracted, the median is nearer.
  double quantile = 0.25;
};

// From pictures with the halo in them. lights_px: of the light's image in each.
[[nodiscard]] HaloProfile halo_of(std::span<const FitStation> stations, std::span<const Vec2> lights_px,
                                  const HaloSettings& settings);

// By how much a station's halo, once ghosts are subtracted, is brighter than the profile has it at this angle, within a
// few per cent: the flux of the light's own image, which pictures are relative to, is measured in a short exposure with
// an error of its own. 1 where too little of it is seen.
[[nodiscard]] double halo_deviation(const HaloProfile& halo, const FitStation& residual, Vec2 light_px,
                                    double masked_px);

// Subtracts the halo times this factor, and adds what it leaves uncertain to the variance. Pixels within `masked_px` of
// the light get no weight.
void subtract_halo(FitStation& station, const HaloProfile& halo, Vec2 light_px, double masked_px, double factor = 1.0);

}  // namespace contrejour::inline internal
