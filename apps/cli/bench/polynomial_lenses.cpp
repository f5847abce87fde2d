// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/polynomial_lenses.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "cli/long_task.h"
#include "contrejour/expert/metrics.h"
#include "contrejour/expert/polynomial_method.h"
#include "contrejour/expert/settings.h"

namespace contrejour::cli {
namespace {

// The paper's f-number, and wide open.
constexpr SceneVariant kFitApertures[] = {{}, {.full_aperture = true}};

bool is_listed_system(const PaperSystem& system, const PolynomialLensOptions& options) {
  return options.systems.empty() || std::ranges::find(options.systems, system.key) != options.systems.end();
}

Result<LensFit> fit_system(const PaperSystem& system, const LensState& lens, const Context& context) {
  const std::clock_t processor = std::clock();
  const auto clock = std::chrono::steady_clock::now();
  auto fit = fit_polynomials(lens, {.scope = GhostScope::OneSideOfStop}, context);
  if (!fit) return tl::unexpected(fit.error());
  LensFit made;
  made.system = &system;
  made.clock_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - clock).count();
  made.processor_s = static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC;
  made.bytes = write_polynomials(*fit).size();
  made.threads = context.threads > 0 ? context.threads : static_cast<int>(std::thread::hardware_concurrency());
  made.fit = std::make_shared<const LensPolynomials>(std::move(*fit));
  return made;
}

// The flux of the channel that differs most, over the reference's.
double worst_flux(const Comparison& compared) {
  return *std::ranges::max_element(compared.flux_ratio, {}, [](double ratio) { return std::abs(ratio - 1.0); });
}

Result<LensPicture> compare_pictures(const BenchScene& scene, const LensFit& fit, const PolynomialLensOptions& options,
                                     const Context& context) {
  const auto reference = reference_picture(scene, {.threads = context.threads, .cache = options.cache});
  if (!reference) return tl::unexpected(reference.error());
  const auto compared = [&](const MethodOptions& method, Flare& flare) -> Result<Comparison> {
    auto drawn = render(method, scene.lens, scene.lights, scene.settings, context);
    if (!drawn) return tl::unexpected(drawn.error());
    flare = std::move(*drawn);
    return compare(*reference, flare.image);
  };
  Flare flare;
  const auto adaptive = compared(params::adaptive_options(scene.values), flare);
  if (!adaptive) return tl::unexpected(adaptive.error());
  const auto polynomial = compared(PolynomialRenderOptions{.fit = fit.fit}, flare);
  if (!polynomial) return tl::unexpected(polynomial.error());
  return LensPicture{.system = scene.system,
                     .f_number = scene.lens.f_number,
                     .width = scene.settings.frame.width,
                     .height = scene.settings.frame.height,
                     .adaptive_db = adaptive->psnr_db,
                     .polynomial_db = polynomial->psnr_db,
                     .adaptive_flux = worst_flux(*adaptive),
                     .polynomial_flux = worst_flux(*polynomial),
                     .traced_flux = flare.statistics.traced_flux.value_or(0.0)};
}

Result<void> measure_system(const PaperSystem& system, const PolynomialLensOptions& options, const Context& context,
                            PolynomialLenses& lenses) {
  std::vector<BenchScene> scenes;
  for (const SceneVariant& aperture : kFitApertures) {
    auto scene = bench_scene(system, 1, aperture, options.values);
    if (!scene) return tl::unexpected(scene.error());
    scenes.push_back(std::move(*scene));
  }
  auto fit = fit_system(system, scenes.back().lens, context);
  if (!fit) return tl::unexpected(fit.error());
  for (const BenchScene& scene : scenes) {
    if (options.fits) fit->errors.push_back(errors_of_fit(*fit->fit, scene.lens));
    if (!options.pictures) continue;
    const auto picture = compare_pictures(scene, *fit, options, context);
    if (!picture) return tl::unexpected(picture.error());
    lenses.pictures.push_back(*picture);
  }
  if (options.fits) lenses.fits.push_back(std::move(*fit));
  return {};
}

}  // namespace

Result<PolynomialLenses> measure_polynomial_lenses(const PolynomialLensOptions& options, const Context& context) {
  PolynomialLenses lenses;
  const Context quiet = without_progress(context);
  if (!options.fits && !options.pictures) return lenses;
  for (const PaperSystem& system : paper_systems())
    if (is_listed_system(system, options))
      if (const auto ok = measure_system(system, options, quiet, lenses); !ok) return tl::unexpected(ok.error());
  return lenses;
}

}  // namespace contrejour::cli
