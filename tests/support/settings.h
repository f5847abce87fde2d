// SPDX-License-Identifier: Apache-2.0
// The settings of a test's frame, for any method.
#pragma once

#include <span>
#include <string_view>

#include <doctest/doctest.h>

#include "contrejour/render.h"

namespace contrejour::test {

// A frame's settings, and the options of those methods that have any: tests that compare methods pass the same object
// to all of them.
struct Settings : FrameSettings {
  AdaptiveOptions adaptive;
  BundleOptions bundle;
  TiledOptions tiled;
  ReferenceOptions reference;

  void set_grid(int rays) { bundle.grid.rays = tiled.grid.rays = rays; }
  void set_error(double error) { adaptive.error = area_error = error; }

  // Errors: there is no such method.
  [[nodiscard]] Result<MethodOptions> options(std::string_view method) const {
    auto all = method_options(method);
    if (!all) return all;
    if (auto* const own = all->get_if<AdaptiveOptions>()) *own = adaptive;
    if (auto* const own = all->get_if<BundleOptions>()) *own = bundle;
    if (auto* const own = all->get_if<TiledOptions>()) *own = tiled;
    if (auto* const own = all->get_if<ReferenceOptions>()) *own = reference;
    return all;
  }
};

inline Result<Flare> render(std::string_view method, const LensState& lens, std::span<const Light> lights,
                            const Settings& settings, const Context& context = {}) {
  const auto options = settings.options(method);
  if (!options) return tl::unexpected(options.error());
  return contrejour::render(*options, lens, lights, settings, context);
}

}  // namespace contrejour::test
