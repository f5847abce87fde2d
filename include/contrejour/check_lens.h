// Is a lens state one that light can be traced through? What lens_at() gives always is, and functions that return
// Result ask this of the state that they are given. Those that return values instead give an empty list, zero or not a
// number for a state that has no surfaces or no stop: none reads beyond it.
// Errors: InvalidArgument, saying what is wrong. Some 10 us for a zoom lens. Thread-safety: pure.
#pragma once

#include <cstddef>

#include "contrejour/ghost_id.h"
#include "contrejour/lens.h"

namespace contrejour {

// A lens has surfaces, at least one that refracts, one stop that stop_index names, and nothing but the last that is the
// sensor. Its numbers are finite and within the ranges of a prescription (validate()); places lie within 1e7 mm.
[[nodiscard]] Result<void> check_lens(const LensState& lens);

// The most surfaces of a prescription, both sides of each plate before the sensor, and the sensor.
inline constexpr std::size_t kMostLensSurfaces = 200 + 2 * SensorStack::kMostPlates + 1;

// One that light can have: X-rays and heat, and all between.
[[nodiscard]] inline bool is_wavelength(double lambda_nm) { return lambda_nm >= 1.0 && lambda_nm <= 1e6; }

// Some surface, and a stop_index among them.
[[nodiscard]] inline bool has_stop(const LensState& lens) {
  return lens.stop_index >= 0 && static_cast<std::size_t>(lens.stop_index) < lens.surfaces.size();
}

// The surfaces that the ghost turns at, in the order that every ghost has them.
[[nodiscard]] inline bool has_surfaces_of(const LensState& lens, const Ghost& ghost) {
  const auto within = [&](int near, int far) {
    return near >= 1 && near < far && static_cast<std::size_t>(far) <= lens.surfaces.size();
  };
  if (!ghost.reflects_four_times()) return ghost.k == 0 && within(ghost.i, ghost.j);
  return within(ghost.i, ghost.j) && within(ghost.k, ghost.l) && ghost.l > ghost.i;
}

}  // namespace contrejour
