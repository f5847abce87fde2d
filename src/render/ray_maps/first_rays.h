// SPDX-License-Identifier: Apache-2.0
// The first rays through a box of a ghost's pupil, few at each wavelength. Bands, tolerances and curved boxes are
// decided from them.
#pragma once

#include <cstddef>
#include <vector>

#include "render/radiometry/wavelength_samples.h"
#include "render/ray_maps/ghost_tracers.h"
#include "render/ray_maps/tolerance.h"

namespace contrejour::inline internal::ray_maps {

struct FirstRays {
  std::vector<LobattoRays> ray_sets;  // one a pass, without weights; no nodes: not traced
  std::vector<std::vector<float>> transmission;  // one a pass, at the nodes: traced or interpolated
  // One a pass: the ratio of its transmittances to those that light_factors() interpolates, common to all nodes; 1 if
  // it was traced.
  std::vector<double> light;
  bool is_linear = false;  // light_factors() are those of straight lines
  std::size_t samples = 0;  // passes traced, in the order of the samples; 0: all were
  double largest_weight = 0.0;  // of any channel at any node, all passes together
  Tolerance tolerance;
};

struct FirstRaysOptions {
  int nodes = 5;  // along a side of the box
  PacketPrecision precision = PacketPrecision::Double;
  double pixel_pitch_mm = 0.01;
  double predicted_fraction = 0.5;  // fraction of the tolerance that interpolation over wavelengths may use
  double max_tint = 0.03;  // of a transmittance: error of its distribution over the ghost
};

// Traces all wavelengths; if there are many, only as many of `samples` as predict the next one within the tolerance.
[[nodiscard]] FirstRays first_rays(GhostTracers& tracers, const WavelengthSamples& samples, const Rectangle& box,
                                   const ToleranceOf& tolerance_of, const FirstRaysOptions& options);

// The factors by which the transmittances of the first `count` samples add up to a pass's, without FirstRays::light.
[[nodiscard]] std::vector<double> light_factors(const WavelengthSamples& samples, std::size_t count, std::size_t pass,
                                                bool is_linear);

// The light of a pass, summed over the nodes.
[[nodiscard]] Rgb light_of(const FirstRays& rays, std::span<const PlannedPass> passes, std::size_t pass);

}  // namespace contrejour::inline internal::ray_maps
