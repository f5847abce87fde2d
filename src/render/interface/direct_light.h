// What a light's own image is, in the units that ghosts are measured against: docs/physics/radiometry.md.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "contrejour/colour.h"
#include "contrejour/context.h"
#include "contrejour/direct_image.h"
#include "contrejour/frame.h"
#include "contrejour/lens.h"
#include "optics/trace/by_wavelength.h"

namespace contrejour {

// A light where it is measured, its bands' wavelengths and, once found, their direct fluxes in mm^2 at E0 = 1.
struct MeteredLight {
  LightSource source;
  std::span<const SpectralBand> bands;
  std::vector<double> flux_mm2 = {};
};

// The bands that measure_fluxes() measures whatever they foretell, and that whose pupil it finds.
[[nodiscard]] std::vector<std::size_t> measured_first(std::span<const SpectralBand> bands);

// Finds all fluxes. Where there are many bands, few are measured if they
// foretell the next to 2e-4 (wavelength_samples.h), and they tell the others, good to 2e-5. False when cancelled.
[[nodiscard]] bool measure_fluxes(const LensState& lens, const TablesByWavelength& tables,
                                  std::span<MeteredLight> lights, const Context& context);

// Sum over the bands of w[c] * Phi, mm^2 at E0 = 1, from each band's direct flux where the light is measured. Of one
// that does not get through there, of a band's flux on the axis, at the light's distance.
[[nodiscard]] Rgb direct_light(std::span<const SpectralBand> bands, std::span<const double> flux_mm2,
                               const std::function<double(std::size_t band)>& flux_on_axis_mm2);

}  // namespace contrejour
