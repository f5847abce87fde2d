// Rows of `bench effects`: what starburst, dirt, ringing and lights with a size cost, each beside its target.
// A new row is a function here and a line in effects.cpp.
#pragma once

#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "cli/bench/target.h"
#include "contrejour/lens.h"
#include "contrejour/render.h"
#include "contrejour/result.h"
#include "params/values.h"

namespace contrejour::cli {

struct EffectScene {
  Prescription prescription;
  LensSettings settings;
  LensState lens;
  std::vector<Light> lights;
  RenderSettings render;
  int runs = 1;
  Context context;
};

// The lens and the light that every row has, on a frame of `values`' size: planar-50 at f/8, 7 blades.
[[nodiscard]] Result<EffectScene> effect_scene(const params::Values& values, int runs);

using MeasureEffect = Result<std::vector<Target>> (*)(const EffectScene& scene);
[[nodiscard]] std::span<const MeasureEffect> effects();

// Of so many runs the fastest, in ms of the clock.
[[nodiscard]] Result<double> fastest_ms(int runs, const std::function<Result<void>()>& run);

// A new iris's, a kept one's, a new dirt's.
[[nodiscard]] Result<std::vector<Target>> measure_starbursts(const EffectScene& scene);

// The sun beside a point, with several lenses.
[[nodiscard]] Result<std::vector<Target>> measure_area_lights(const EffectScene& scene);

}  // namespace contrejour::cli
