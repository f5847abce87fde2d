// SPDX-License-Identifier: Apache-2.0
#include "render/planning/frame_plan.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "base/clock.h"
#include "base/tasks.h"
#include "render/planning/ghost_selection.h"
#include "render/planning/kept_dirt.h"
#include "render/planning/kept_ghost_fluxes.h"
#include "render/planning/statistics.h"
#include "render/pupils/direct_meter.h"
#include "render/radiometry/check_frame.h"
#include "render/radiometry/direct_light.h"
#include "render/radiometry/lens_tables.h"

namespace contrejour::inline internal {
namespace {

constexpr int kMaxWavelengths = 1024;
constexpr int kAutoBands = 32;  // as many as a caustic of a fisheye in a large frame needs

Error invalid(std::string message) { return {ErrorCode::InvalidArgument, std::move(message), {}}; }

std::optional<Error> problem_with(const LensState& lens, std::span<const Light> lights, const FrameSettings& settings) {
  if (const auto good = check_frame(settings.frame); !good) return good.error();
  if (settings.lambda_nm.empty() && (settings.wavelengths < 0 || settings.wavelengths > kMaxWavelengths)) {
    return invalid(fmt::format("{} wavelengths is out of range; choose 1 to {}, or 0 for as many as are needed",
                               settings.wavelengths, kMaxWavelengths));
  }
  for (std::size_t k = 0; k < lights.size(); ++k) {
    auto good = check_light(lights[k], settings.colour_space);
    if (good) good = check_source(lens, lights[k].source());
    if (!good) return invalid(fmt::format("light {}: {}", k + 1, good.error().message));
  }
  return std::nullopt;
}

std::vector<SpectralBand> bands_of(const Light& light, const FrameSettings& settings) {
  const int count = settings.wavelengths == kAutoWavelengths ? kAutoBands : settings.wavelengths;
  if (settings.lambda_nm.empty()) return spectral_bands(count, light.spectrum, settings.colour_space);
  std::vector<SpectralBand> bands;
  const double weight = 1.0 / static_cast<double>(settings.lambda_nm.size());
  for (const double lambda_nm : settings.lambda_nm) bands.push_back({lambda_nm, {weight, weight, weight}});
  std::ranges::sort(bands, {}, &SpectralBand::lambda_nm);
  return bands;
}

// Lights with the same spectrum use the same bands.
using BandsBySpectrum = std::vector<std::pair<Spectrum, std::vector<SpectralBand>>>;

BandsBySpectrum bands_by_spectrum(std::span<const Light> lights, const FrameSettings& settings) {
  BandsBySpectrum all;
  for (const Light& light : lights) {
    const auto same = [&](const auto& entry) { return entry.first == light.spectrum; };
    if (std::any_of(all.begin(), all.end(), same)) continue;
    all.emplace_back(light.spectrum, bands_of(light, settings));
  }
  return all;
}

std::vector<double> wavelengths_of(const BandsBySpectrum& spectra) {
  std::vector<double> all;
  for (const auto& [spectrum, bands] : spectra)
    for (const SpectralBand& band : bands) all.push_back(band.lambda_nm);
  return all;
}

// What takes long and needs no fluxes; its parts are computed in parallel: the positions where lights are measured, the
// reflectance tables of the wavelengths that their fluxes are measured at, and the lens's dirt.
struct Preparation {
  std::vector<LightSource> measured;  // one for each light
  TablesByWavelength tables;
  std::shared_ptr<const DirtField> dirt;
};

// nullopt when cancelled.
std::optional<Preparation> prepare(const FrameRequest& request, const TablesByWavelength& tables,
                                   const BandsBySpectrum& spectra, const Context& context) {
  const auto& [lens, lights, settings, cache, layers] = request;
  const std::shared_ptr<KeptDirt> dirt = cache.section<KeptDirt>(KeptDirt::key_of(lens));
  Preparation out;
  out.tables = tables;
  for (const Light& light : lights) out.measured.push_back(light.source());
  std::set<double> wavelengths;
  for (const auto& [spectrum, bands] : spectra)
    for (const std::size_t band : measured_first(bands)) wavelengths.insert(bands[band].lambda_nm);
  const std::vector<double> lambda_nm(wavelengths.begin(), wavelengths.end());
  const bool done = parallel_for(lights.size() + lambda_nm.size() + 1, context, [&](std::size_t k) {
    if (k < lights.size()) {
      out.measured[k] = measured_source(lens, settings.frame, out.measured[k]);
    } else if (k == lights.size() + lambda_nm.size()) {
      out.dirt = dirt->field(lens);
    } else {
      (void)out.tables.at(lambda_nm[k - lights.size()]);
    }
  });
  return done ? std::optional(std::move(out)) : std::nullopt;
}

const std::vector<SpectralBand>& bands_for(const Light& light, const BandsBySpectrum& spectra) {
  return std::find_if(spectra.begin(), spectra.end(), [&](const auto& entry) { return entry.first == light.spectrum; })
      ->second;
}

// The factor on a light's ghosts that depends on where its image lies (GhostOptions::edge_gain).
double edge_gain(const LensState& lens, const Light& light, const FrameSettings& settings) {
  const double at_corner = settings.ghosts.edge_gain;
  if (at_corner == 1.0) return 1.0;
  const Frame& frame = settings.frame;
  const double corner_mm = 0.5 * std::hypot(frame.full_width, frame.full_height) * frame.pixel_pitch_mm;
  const double image_mm = length(chief_ray_image_point(lens, light.source(), lens.design_wavelength_nm));
  return std::lerp(1.0, at_corner, std::min(1.0, image_mm / corner_mm));
}

PlannedLight plan_light(const LensState& lens, const TablesByWavelength& tables, const Light& light,
                        const MeteredLight& metered, double ghost_gain) {
  PlannedLight planned;
  planned.source = light.source();
  const Rgb whole = direct_light(metered.bands, metered.flux_mm2, [&](std::size_t k) {
    const LightSource on_axis({0.0, 0.0, 1.0}, light.distance_mm);
    return DirectMeter(lens, on_axis).flux_mm2(tables.at(metered.bands[k].lambda_nm));
  });
  for (const SpectralBand& band : metered.bands) {
    PlannedPass pass{band.lambda_nm, {}, band.spread_nm};
    for (std::size_t c = 0; c < whole.size(); ++c) {
      pass.gain[c] = whole[c] != 0.0 ? ghost_gain * light.value[c] * band.weight[c] / whole[c] : 0.0;
    }
    planned.passes.push_back(std::move(pass));
  }
  return planned;
}

// measured: one for each light. nullopt when cancelled.
std::optional<std::vector<PlannedLight>> plan_lights(const LensState& lens, std::span<const Light> lights,
                                                     const FrameSettings& settings, const BandsBySpectrum& spectra,
                                                     std::span<const LightSource> measured,
                                                     const TablesByWavelength& tables, KeptFluxes& kept,
                                                     const Context& context) {
  std::vector<MeteredLight> metered;
  for (std::size_t k = 0; k < lights.size(); ++k) metered.push_back({measured[k], bands_for(lights[k], spectra)});
  if (!measure_fluxes(lens, tables, kept, metered, context)) return std::nullopt;
  std::vector<PlannedLight> planned;
  for (std::size_t k = 0; k < lights.size(); ++k) {
    planned.push_back(plan_light(lens, tables, lights[k], metered[k], edge_gain(lens, lights[k], settings)));
    planned.back().index = k;
  }
  return planned;
}

}  // namespace

Result<FramePlan> plan_frame(const FrameRequest& request, const Context& context) {
  const auto& [lens, lights, settings, cache, layers] = request;
  if (const auto problem = problem_with(lens, lights, settings)) return tl::unexpected<Error>(*problem);
  if (const auto good = check_ghost_options(lens, settings.ghosts); !good) return tl::unexpected(good.error());
  if (const auto good = check_selection(lens, settings.selection); !good) return tl::unexpected(good.error());
  if (layers != nullptr)
    if (const auto good = check_layers(lens, *layers); !good) return tl::unexpected(good.error());

  FramePlan plan;
  Context quiet = context;
  quiet.progress = {};
  const BandsBySpectrum spectra = bands_by_spectrum(lights, settings);
  const std::shared_ptr<LensTables> kept = cache.section<LensTables>(lens);
  auto prepared = prepare(request, kept->tables(), spectra, quiet);
  if (!prepared) return interrupted();
  plan.kept_fluxes = cache.section<KeptFluxes>(KeptFluxes::key_of(lens));
  plan.kept_pupils = cache.section<pupils::KeptPupils>(pupils::KeptPupils::key_of(lens));
  auto planned =
      plan_lights(lens, lights, settings, spectra, prepared->measured, prepared->tables, *plan.kept_fluxes, quiet);
  if (!planned) return interrupted();
  plan.lights = std::move(*planned);
  plan.tables = std::move(prepared->tables);
  plan.dirt = std::move(prepared->dirt);
  plan.adapts_passes = settings.lambda_nm.empty() && settings.wavelengths == kAutoWavelengths;
  plan.reflectances = kept->reflectances(wavelengths_of(spectra));
  const bool measures = layers != nullptr && needs_flux(*layers);
  const auto fluxes = cache.section<KeptGhostFluxes>(KeptGhostFluxes::key_of(lens));
  auto selected =
      select_ghosts(lens, plan.lights, plan.tables, {*plan.kept_pupils, *fluxes}, settings, measures, quiet);
  if (!selected) return tl::unexpected<Error>(selected.error());
  plan.ghosts = std::move(selected->ghosts);
  plan.adjustments = applied_adjustments(lens, plan.ghosts, settings.ghosts, settings.frame);
  if (const auto good = check_brightness(lights, plan.ghosts, plan.adjustments, settings.ghosts); !good)
    return tl::unexpected(good.error());
  plan.skipped_flux = selected->skipped_flux;
  plan.pupils = std::move(selected->pupils);
  if (layers != nullptr)
    plan.layers = std::make_shared<const LayerMap>(*layers, plan.ghosts, selected->flux_fractions, lights);
  return plan;
}

Result<std::vector<PlannedLight>> plan_more_lights(const FramePlan& plan, const LensState& lens,
                                                   std::span<const Light> lights, const FrameSettings& settings,
                                                   const Context& context) {
  std::vector<LightSource> measured(lights.size());
  parallel_for(lights.size(), context,
               [&](std::size_t k) { measured[k] = measured_source(lens, settings.frame, lights[k].source()); });
  const BandsBySpectrum spectra = bands_by_spectrum(lights, settings);
  if (context.cancelled()) return interrupted();
  auto planned = plan_lights(lens, lights, settings, spectra, measured, plan.tables, *plan.kept_fluxes, context);
  if (!planned) return interrupted();
  return std::move(*planned);
}

Result<GhostImages> render_planned(const DrawPlan& draw, const FrameRequest& frame, const Context& context) {
  const auto start = Clock::now();
  const auto plan = plan_frame(frame, context);
  if (!plan) return tl::unexpected<Error>(plan.error());
  const double plan_ms = ms_since(start);
  auto drawn = draw({frame.lens, *plan, frame.settings, frame.cache}, context);
  if (!drawn) return tl::unexpected<Error>(drawn.error());
  count_first(drawn->statistics, "plan", plan_ms);
  return GhostImages{std::move(drawn->picture.image), std::move(drawn->layers), plan->layers,
                     std::move(drawn->statistics)};
}

}  // namespace contrejour::inline internal
