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

  // A rectangle with a margin that encloses every ray that gets through at the tables' wavelength. None if no ray does.
  [[nodiscard]] std::optional<Rectangle> pupil(const ReflectanceTables& tables) const;

  // Flux at that wavelength, mm^2 at E0 = 1, to 5e-4. near: pupil() at another wavelength; if it does not contain this
  // wavelength's pupil, that is searched.
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
