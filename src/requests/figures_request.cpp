// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/requests.h"
#include "contrejour/expert/settings.h"

namespace contrejour {
namespace {

constexpr int kDefaultBands = 6;  // fluxes are then accurate to some per cent

std::vector<SpectralBand> bands_of_figures(const params::Values& values, const Light& light) {
  if (const auto lambda_nm = values.real("wavelength")) return {{*lambda_nm, {1.0, 1.0, 1.0}}};
  const int given = *params::parse_wavelengths(*values.text("wavelengths"));
  return spectral_bands(given == kAutoWavelengths ? kDefaultBands : given, light.spectrum, ColourSpace::Rec709);
}

}  // namespace

Result<FiguresRequest> figures_request(const params::Values& values, const LensState& lens, const Light* light) {
  FiguresRequest request;
  request.frame = params::whole_frame(values, lens, *params::parse_size(*values.text("size")));
  if (light != nullptr) {
    request.light = *light;
  } else {
    const auto lights = params::lights(values, lens, request.frame, ColourSpace::Rec709);
    if (!lights) return tl::unexpected(lights.error());
    request.light = lights->front();
  }
  request.scope = params::ghost_scope(values);
  request.reflections = params::reflections(values);
  request.bands = bands_of_figures(values, request.light);
  return request;
}

}  // namespace contrejour
