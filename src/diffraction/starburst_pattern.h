// SPDX-License-Identifier: Apache-2.0
// The pattern of a real mask at one wavelength, from its middle to any distance: its spectrum within its samples, then
// the diffraction by its outline and its dirt. It is a density over rho = x / (lambda N) with integral 1.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/pupil_mask.h"
#include "contrejour/expert/starburst.h"
#include "diffraction/direction_means.h"
#include "diffraction/dirt_waves.h"
#include "diffraction/power_grid.h"
#include "diffraction/uneven_edges.h"

namespace contrejour::inline internal {

class StarburstPattern {
 public:
  // outline: null where the mask has none.
  StarburstPattern(const PupilMask& mask, const PupilOutline* outline, double pupil_radius_mm, const Context& context);

  // Computes averages over rings and a window of directions, at radii from first_rho on, row by row; out is [row *
  // stride].
  void sample(double angle_rad, double window_rad, double first_rho, int rows, float* out, std::size_t stride) const;

  // Directions (radians, up to their sign) along which the pattern may be sharp at any distance: normals of straight
  // edges and scratches, and those at the ends of curved ones.
  [[nodiscard]] std::vector<double> sharp_directions() const;

  [[nodiscard]] double spectrum_end() const { return tail_start_; }  // rho, from which on a tail takes over

 private:
  // The pattern of one direction beyond the spectrum.
  struct Tail {
    std::optional<UnevenEdges::Direction> edges;
    double scale = 0;  // of these
    double stretch = 1;  // wave numbers of the opening over those of the pupil
    double scattered = 0;  // times rho^-3: other scattered light
    std::optional<DirtWaves::Direction> obscurations;
    double obscurations_scale = 0;
    std::optional<DirtWaves::Direction> dirt;
    double dirt_scale = 0;  // of these
    double dirt_stretch = 1;  // wave numbers in the dirt's plane over rho

    [[nodiscard]] double times_rho3(double rho) const;
  };
  [[nodiscard]] Tail tail_along(double angle_rad, double window_rad) const;
  void add_edges(double angle_rad, double window_rad, Tail& tail) const;
  void add_dirt(double angle_rad, double window_rad, Tail& tail) const;
  void measure_grain(const Context& context);
  [[nodiscard]] double grain_along(double angle_rad, double window_rad) const;
  [[nodiscard]] double spectrum_average(double angle_rad, Vec2 along, double window_rad, double rho) const;

  double across_, power_mm2_;
  bool clean_;  // nothing dims the mask but its outline
  PowerGrid grid_;
  std::optional<UnevenEdges> edges_;
  double tail_start_ = 0, tail_end_ = 0, edge_scale_ = 0;
  Vec2 outline_x_, outline_y_;  // the opening's unit vectors in pupil radii
  std::optional<DirtWaves> obscurations_;
  double obscurations_scale_ = 0;
  std::optional<DirtWaves> dirt_;
  double dirt_scale_ = 0;
  Vec2 dirt_x_, dirt_y_;  // the dirt's unit vectors in pupil radii
  DirectionMeans halo_, shapes_;  // times rho^3, where the spectrum ends: its own less the edges', and of all dirt
};

}  // namespace contrejour::inline internal
