// SPDX-License-Identifier: Apache-2.0
// Renders that must succeed.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

#include <doctest/doctest.h>

#include "support/settings.h"

namespace contrejour::test {

// Renders a flare and requires that all its values are finite.
inline Flare flare_of(std::string_view method, const LensState& lens, std::span<const Light> lights,
                      const Settings& settings, const Context& context = {}) {
  auto flare = render(method, lens, lights, settings, context);
  REQUIRE(flare.has_value());
  const auto& pixels = flare->image.pixels;
  CHECK(std::all_of(pixels.begin(), pixels.end(), [](float v) { return std::isfinite(v); }));
  return *flare;
}

}  // namespace contrejour::test
