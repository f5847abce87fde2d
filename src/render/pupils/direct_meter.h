// SPDX-License-Identifier: Apache-2.0
// Measures the direct image of one light: its pupil and its flux. The pupils of all wavelengths nearly agree, so one
// search serves them all.
#pragma once

#include <optional>

#include "contrejour/expert/trace.h"
#include "ghosts/iris_shape.h"
#include "ghosts/ray_grid.h"

namespace contrejour::inline internal {

// Thread-safety: safe.
class DirectMeter {
 public:
  // The lens must outlive it.
  DirectMeter(const LensState& lens, const LightSource& light);

  // A rectangle with a margin around the rays that get through at the tables' wavelength, or around most of them, from
  // where flux_mm2() finds all. None if no ray does.
  [[nodiscard]] std::optional<Rectangle> pupil(const ReflectanceTables& tables) const;

  // Flux at that wavelength, mm^2 at E0 = 1, to 5e-4. near: pupil() at another wavelength; if it contains only a part
  // of this wavelength's pupil, it is extended.
  [[nodiscard]] double flux_mm2(const ReflectanceTables& tables, const Rectangle& near) const;
  [[nodiscard]] double flux_mm2(const ReflectanceTables& tables) const;

 private:
  [[nodiscard]] RayGrid traced(const ReflectanceTables& tables, const Rectangle& box) const;

  const LensState& lens_;
  LightSource light_;
  IrisShape iris_;
  EntranceWindow window_;
};

}  // namespace contrejour::inline internal
