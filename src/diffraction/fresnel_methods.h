// SPDX-License-Identifier: Apache-2.0
// Two methods for the same Fresnel pattern, each valid where its samples are dense enough.
#pragma once

#include "contrejour/expert/fresnel.h"

namespace contrejour::inline internal {

// By the spectrum times the transfer function of free space: for large F.
[[nodiscard]] std::vector<double> fresnel_near(const PupilMask& mask, double stop_radius_mm, double fresnel_number,
                                               int side, double extent, const Context& context);

// By one Fourier transform of the mask times a chirp: for small F.
[[nodiscard]] std::vector<double> fresnel_far(const PupilMask& mask, double stop_radius_mm, double fresnel_number,
                                              int side, double extent, const Context& context);

// Up to here the chirp's fringes are well sampled at the mask's rim, and the pattern's repetitions, K / (2 F) radii
// apart for K samples across the stop, lie far outside it.
[[nodiscard]] double far_up_to(const PupilMask& mask, double stop_radius_mm);

}  // namespace contrejour::inline internal
