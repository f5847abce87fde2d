// SPDX-License-Identifier: Apache-2.0
// A pupil's pattern and a light's wavelengths, from which starbursts of any pixel pitch are made.
#pragma once

#include <memory>
#include <span>

#include "contrejour/expert/starburst.h"
#include "diffraction/band_shifts.h"

namespace contrejour::inline internal {

class StarburstPattern;

class StarburstSource {
 public:
  StarburstSource() = default;  // of a closed pupil: its starbursts draw nothing

  // settings: distance and radius of the pupil; pitch and radius in pixels are for `at`. Errors: those of
  // make_starburst.
  [[nodiscard]] static Result<StarburstSource> make(const PupilMask& mask, const PupilOutline* outline,
                                                    std::span<const SpectralBand> bands,
                                                    const StarburstSettings& settings, const Context& context);

  [[nodiscard]] Result<Starburst> at(double pixel_pitch_mm, double radius_px, const Context& context) const;

 private:
  std::shared_ptr<const StarburstPattern> pattern_;
  BandShifts shifts_;
  double rho_per_mm_ = 0.0;
};

}  // namespace contrejour::inline internal
