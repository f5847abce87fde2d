// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/lens_starburst.h"

#include <algorithm>

#include "base/tasks.h"
#include "render/starburst/lens_pattern.h"

namespace contrejour::inline internal {
namespace {

// The lens's transmittance at each wavelength, averaged over some of the pupil's rays.
std::vector<double> transmissions(const LensState& lens, const LightSource& light, const std::vector<Vec3>& rays_mm,
                                  std::span<const SpectralBand> bands, const Context& context) {
  std::vector<double> mean(bands.size());
  parallel_for(bands.size(), context, [&](std::size_t k) {
    const OpticalPath path = direct_path(lens, bands[k].lambda_nm);
    for (const Vec3 from : rays_mm)
      mean[k] += trace(path, {from, light.direction_at(from)}).transmission / static_cast<double>(rays_mm.size());
  });
  return mean;
}

// The weights times the transmittances, scaled so that each channel sums to `whole_fraction`.
std::vector<SpectralBand> transmitted(std::span<const SpectralBand> bands, const std::vector<double>& transmission,
                                      double whole_fraction) {
  std::vector<SpectralBand> out(bands.begin(), bands.end());
  Rgb whole{};
  for (std::size_t k = 0; k < out.size(); ++k)
    for (std::size_t c = 0; c < whole.size(); ++c) whole[c] += out[k].weight[c] *= transmission[k];
  for (SpectralBand& band : out)
    for (std::size_t c = 0; c < whole.size(); ++c)
      band.weight[c] = whole[c] != 0.0 ? whole_fraction * band.weight[c] / whole[c] : 0.0;
  return out;
}

}  // namespace

Result<StarburstSource> lens_pattern(const LensState& lens, const LightSource& light,
                                     std::span<const SpectralBand> bands, const LensStarburstSettings& settings,
                                     const Context& context) {
  StarburstSettings made{1.0, 1.0, settings.pixel_pitch_mm, settings.radius_px};
  const auto pupil = exit_pupil(lens, light, lens.design_wavelength_nm, made.samples_across, context);
  if (!pupil) return tl::unexpected(pupil.error());
  if (!(pupil->radius > 0.0) || !(pupil->open_fraction > 0.0)) return StarburstSource();
  Context quiet = context;
  quiet.progress = {};
  const LightSource along(normalized(light.direction), light.distance_mm);
  const auto weighted =
      transmitted(bands, transmissions(lens, along, pupil->rays_mm, bands, quiet), pupil->open_fraction);
  made.pupil_radius_mm = pupil->radius;
  return StarburstSource::make(pupil->mask, pupil->outline ? &*pupil->outline : nullptr, weighted, made, quiet);
}

}  // namespace contrejour::inline internal

namespace contrejour {

Result<Starburst> lens_starburst(const LensState& lens, const LightSource& light, std::span<const SpectralBand> bands,
                                 const LensStarburstSettings& settings, const Context& context) {
  const auto source = lens_pattern(lens, light, bands, settings, context);
  if (!source) return tl::unexpected(source.error());
  return source->at(settings.pixel_pitch_mm, settings.radius_px, context);
}

}  // namespace contrejour
