// SPDX-License-Identifier: Apache-2.0
// The power spectrum of a real mask by FFT, interpolated at any frequency.
// Frequencies are rho = f * 2 a, a the pupil's radius: an image point lies at x = rho lambda N. Density: the integral
// over the plane of rho is 1.
#pragma once

#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/pupil_mask.h"

namespace contrejour::inline internal {

class PowerGrid {
 public:
  // up_to: the largest frequency that is read; it is lowered to what the mask's samples resolve. power_mm2: the
  // integral of amplitude squared. edges: samples are averages over their area, and the spectrum is divided by the
  // sample's sinc.
  PowerGrid(const PupilMask& mask, double pupil_radius_mm, double up_to, double power_mm2, bool edges,
            const Context& context);

  [[nodiscard]] double up_to() const { return up_to_; }
  [[nodiscard]] double density(double rho_x, double rho_y) const;  // rho_x >= 0: the other half is its mirror image

 private:
  double up_to_ = 0, step_ = 1;
  int half_ = 0;  // rows -half_..half_, columns -1..half_
  std::size_t width_ = 0;
  std::vector<float> density_;
};

}  // namespace contrejour::inline internal
