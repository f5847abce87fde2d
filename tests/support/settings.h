// SPDX-License-Identifier: Apache-2.0
// The settings of a test's frame, for any method.
#pragma once

#include <span>
#include <string_view>

#include <doctest/doctest.h>

#include "contrejour/expert/polynomial_method.h"
#include "contrejour/render.h"
#include "support/fits.h"

namespace contrejour::test {

// A frame's settings, and the options of those methods that have any: tests that compare methods pass the same object
// to all of them.
struct Settings : FrameSettings {
  AdaptiveOptions adaptive;
  BundleOptions bundle;
  TiledOptions tiled;
  ReferenceOptions reference;
  PolynomialRenderOptions polynomial;

  void set_grid(int rays) { bundle.grid.rays = tiled.grid.rays = rays; }
  void set_error(double error) { adaptive.error = polynomial.error = area_error = error; }

  // Errors: there is no such method.
  [[nodiscard]] Result<MethodOptions> options(std::string_view method) const {
    auto all = method_options(method);
    if (!all) return all;
    if (auto* const own = all->get_if<AdaptiveOptions>()) *own = adaptive;
    if (auto* const own = all->get_if<BundleOptions>()) *own = bundle;
    if (auto* const own = all->get_if<TiledOptions>()) *own = tiled;
    if (auto* const own = all->get_if<ReferenceOptions>()) *own = reference;
    if (auto* const own = all->get_if<PolynomialRenderOptions>()) *own = polynomial;
    return all;
  }
};

// The same, with a fit of the lens where the method draws from one.
inline Result<MethodOptions> options_for(std::string_view method, const LensState& lens, const Settings& settings) {
  auto options = settings.options(method);
  if (!options) return options;
  if (auto* const own = options->get_if<PolynomialRenderOptions>())
    if (!own->fit && !own->range && own->file.empty()) own->fit = shared_fit(lens, settings);
  return options;
}

inline Result<Flare> render(std::string_view method, const LensState& lens, std::span<const Light> lights,
                            const Settings& settings, const Context& context = {}) {
  const auto options = options_for(method, lens, settings);
  if (!options) return tl::unexpected(options.error());
  return contrejour::render(*options, lens, lights, settings, context);
}

}  // namespace contrejour::test
