// The direct image of one light: where it comes through the lens, and how much. Wavelengths' pupils are nearly one, so
// that the search for one of them does for all.
#pragma once

#include <optional>

#include "contrejour/trace.h"
#include "ghosts/iris_shape.h"
#include "ghosts/ray_grid.h"

namespace contrejour {

// Thread-safety: safe.
class DirectMeter {
 public:
  // The lens must outlive it.
  DirectMeter(const LensState& lens, const LightSource& light);

  // Encloses every ray that gets through at the tables' wavelength, with a margin. None: nothing does.
  [[nodiscard]] std::optional<Rectangle> pupil(const ReflectanceTables& tables) const;

  // Flux at that wavelength, mm^2 at E0 = 1, to 5e-4. near: what pupil() found at another one; where it does not hold
  // all of this one's, that is searched for.
  [[nodiscard]] double flux_mm2(const ReflectanceTables& tables, const Rectangle& near) const;
  [[nodiscard]] double flux_mm2(const ReflectanceTables& tables) const;

 private:
  [[nodiscard]] RayGrid traced(const ReflectanceTables& tables, const Rectangle& box) const;

  const LensState& lens_;
  LightSource light_;
  IrisShape iris_;
  EntranceWindow window_;
};

}  // namespace contrejour
