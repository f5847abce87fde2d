// SPDX-License-Identifier: Apache-2.0
// Checks whether light can be traced through a lens state. States from configure_lens() always pass. Functions that
// return Result check the state they are given; functions that return values give an empty list, zero or NaN for a
// state without surfaces or without a stop, and never read out of bounds. Errors: InvalidArgument, saying what is
// wrong. Some 10 us for a zoom lens. Thread-safety: pure.
#pragma once

#include <cstddef>

#include "contrejour/expert/ghost_id.h"
#include "contrejour/export.h"
#include "contrejour/lens.h"

namespace contrejour {

// A valid lens has at least one refracting surface and one stop, at stop_index; only its last surface may be the
// sensor. Its numbers are finite and within the ranges of a prescription (validate()); positions lie within 1e7 mm.
[[nodiscard]] CONTREJOUR_API Result<void> check_lens(const LensState& lens);

// The largest prescription, both sides of each plate in front of the sensor, and the sensor.
inline constexpr std::size_t kMaxLensSurfaces = 200 + 2 * SensorStack::kMaxPlates + 1;

// Accepts wavelengths from X-rays to thermal infrared.
[[nodiscard]] inline bool is_wavelength(double lambda_nm) { return lambda_nm >= 1.0 && lambda_nm <= 1e6; }

// True if stop_index is the index of a surface.
[[nodiscard]] inline bool has_stop(const LensState& lens) {
  return lens.stop_index >= 0 && static_cast<std::size_t>(lens.stop_index) < lens.surfaces.size();
}

// True if the lens has all surfaces at which the ghost reflects, and they are in the order that a Ghost requires.
[[nodiscard]] inline bool has_surfaces_of(const LensState& lens, const Ghost& ghost) {
  const auto within = [&](int near, int far) {
    return near >= 1 && near < far && static_cast<std::size_t>(far) <= lens.surfaces.size();
  };
  if (!ghost.reflects_four_times()) return ghost.k == 0 && within(ghost.i, ghost.j);
  return within(ghost.i, ghost.j) && within(ghost.k, ghost.l) && ghost.l > ghost.i;
}

}  // namespace contrejour
