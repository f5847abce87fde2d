// SPDX-License-Identifier: Apache-2.0
// Diffraction of an aperture between its sharp shadow and its far field: the ringing along a ghost's rim.
// The pattern depends on one number, F = a^2 / (lambda z), with a the stop's radius; it is scaled to the geometric
// footprint, whose radius and irradiance are 1. Through lenses z is an effective distance: fresnel_number. Accuracy: F
// * footprint <= 1e5; intensities to 2 per cent of 1 for a mask of 512 samples across, better with more samples;
// unresolved fringes vanish, they do not alias. Thread-safety: pure functions.
// Source: Goodman 2005 eq. 4-17, Collins 1970 eq. 12, Matsushima & Shimobaba 2009.
#pragma once

#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/pupil_mask.h"
#include "contrejour/export.h"

namespace contrejour {

struct FresnelSettings {
  double fresnel_number = 10.0;  // > 0; infinite: the sharp mask
  int side = 512;                // samples of the pattern
  double extent = 0.0;           // half the pattern's width in footprint radii; 0: fresnel_extent
};

struct FresnelPattern {
  int side = 0;
  double extent = 0.0;             // rows from the top, positions as in MaskGrid of pitch 2 extent / side
  std::vector<double> irradiance;  // empty when cancelled
  double flux = 0.0;  // flux of the pattern over the flux through the mask: 1 less what spreads beyond the
                      // extent
};

// 1 + 2 / sqrt(F) + 4 / F: 97 per cent of the light at any F.
[[nodiscard]] CONTREJOUR_API double fresnel_extent(double fresnel_number);

[[nodiscard]] CONTREJOUR_API FresnelPattern fresnel_pattern(const PupilMask& mask, double stop_radius_mm,
                                                            const FresnelSettings& settings,
                                                            const Context& context = {});

// From the stop to the sensor through a system of first order [A B; C D] in air (Collins 1970): F = A a^2 / (lambda B).
// A light whose wavefront at the stop has the curvature c (1 / mm, > 0 diverging) makes A + B c of A. The footprint is
// |A| a, upside down where A < 0. B = 0 images the stop: F is infinite.
[[nodiscard]] CONTREJOUR_API double fresnel_number(double stop_radius_mm, double a, double b_mm, double lambda_nm);

}  // namespace contrejour
