// SPDX-License-Identifier: Apache-2.0
// The flux of a light's direct image, which is the unit of the ghosts' fluxes: docs/physics/radiometry.md.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/colour.h"
#include "contrejour/expert/direct_image.h"
#include "contrejour/frame.h"
#include "contrejour/lens.h"
#include "optics/trace/by_wavelength.h"
#include "render/radiometry/kept_fluxes.h"

namespace contrejour::inline internal {

// A light at the position where its flux is measured, the bands with their wavelengths, and the bands' direct fluxes in
// mm^2 at E0 = 1, which measure_fluxes() fills in.
struct MeteredLight {
  LightSource source;
  std::span<const SpectralBand> bands;
  std::vector<double> flux_mm2 = {};
};

// The bands that measure_fluxes() needs in any case: those of its first round, and the band whose pupil it finds.
[[nodiscard]] std::vector<std::size_t> measured_first(std::span<const SpectralBand> bands);

// Finds all fluxes. Where there are many bands, only some are measured: once they predict the next one to 2e-4 of the
// largest flux, the others are interpolated (wavelength_samples.h) with an error of about 2e-5. Those that an earlier
// frame measured are taken from `kept`, which then contains all. Returns false when cancelled.
[[nodiscard]] bool measure_fluxes(const LensState& lens, const TablesByWavelength& tables, KeptFluxes& kept,
                                  std::span<MeteredLight> lights, const Context& context);

// The sum over the bands of w[c] * Phi, in mm^2 at E0 = 1, with Phi the band's direct flux where the light is measured.
// If the light does not get through there, Phi is the band's flux on the axis at the light's distance.
[[nodiscard]] Rgb direct_light(std::span<const SpectralBand> bands, std::span<const double> flux_mm2,
                               const std::function<double(std::size_t band)>& flux_on_axis_mm2);

}  // namespace contrejour::inline internal
