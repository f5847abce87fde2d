// SPDX-License-Identifier: Apache-2.0
// The flux that each of a ghost's many passes carries through a box, measured with a few more rays than the first ones:
// films make it vary less smoothly with wavelength than positions do.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "render/radiometry/wavelength_samples.h"
#include "render/ray_maps/ghost_tracers.h"

namespace contrejour::inline internal::ray_maps {

// Measures at 3 x 3 of the first rays' nodes: those whose rays arrive at all of the first `count` samples.
class WavelengthFlux {
 public:
  // All arguments must outlive this object. ray_sets: one a pass, those of the first `count` samples traced.
  WavelengthFlux(GhostTracers& tracers, std::span<const LobattoRays> ray_sets, const WavelengthSamples& samples,
                 std::size_t count);

  [[nodiscard]] bool any() const;  // whether a node counts

  // Adds up the values at the nodes that count; `transmission` has one at every node of the first rays.
  [[nodiscard]] double sum(std::span<const float> transmission) const;

  // One sum() a pass: measured at 7, 10 or 13 wavelengths, as soon as these predict the last of them to 0.4 per cent of
  // the largest sum; else at all wavelengths.
  [[nodiscard]] std::vector<double> of_all();

 private:
  [[nodiscard]] double of(std::size_t pass);
  [[nodiscard]] double predicted(const std::vector<double>& light, std::size_t count, std::size_t pass) const;

  GhostTracers& tracers_;
  std::span<const LobattoRays> ray_sets_;
  const WavelengthSamples& samples_;
  std::vector<std::size_t> at_;  // among the first rays' nodes
  std::vector<bool> counts_;
};

}  // namespace contrejour::inline internal::ray_maps
