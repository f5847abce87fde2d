// Rows of `bench effects`: what starburst, dirt, ringing and lights with a size cost, each beside its target.
// A new row is a function here and a line in effects.cpp.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/bench/target.h"
#include "contrejour/lens.h"
#include "contrejour/parameter_values.h"
#include "contrejour/render.h"
#include "contrejour/result.h"

namespace contrejour::cli {

struct EffectScene {
  Prescription prescription;
  LensSettings settings;
  LensState lens;
  std::vector<Light> lights;
  AdaptiveOptions adaptive;
  FrameSettings render;
  int runs = 1;
  Context context;
};

// The lens and the light that every row has, on a frame of `values`' size: planar-50 at f/8, 7 blades.
[[nodiscard]] Result<EffectScene> effect_scene(const params::Values& values, int runs);

using MeasureEffect = Result<std::vector<Target>> (*)(const EffectScene& scene);
[[nodiscard]] std::span<const MeasureEffect> effects();

// The scene's light and size of picture with another lens.
struct EffectSystem {
  const char* lens;
  double focal_length_mm;  // 0: no zoom
  double f_number;
};
[[nodiscard]] Result<EffectScene> with_lens(const EffectScene& scene, const EffectSystem& system);

// One renderer renders with an effect and without, in turns, so that what changes while they run changes both, and
// keeps what a sequence of frames would. Of the scene's runs (repeats.h) the fastest, in processor time of all threads
// together, which other programs do not take from.
struct EffectRender {
  FrameSettings settings;
  std::vector<Light> lights;
};
struct EffectCost {
  double without_ms = 0.0, with_ms = 0.0;
  [[nodiscard]] double ratio() const { return with_ms / without_ms; }
};
[[nodiscard]] Result<EffectCost> cost_in_turns(const EffectScene& scene, const EffectRender& without,
                                               const EffectRender& with);

// "f/8, 40.1 ms, 30.0 ms of processor time".
[[nodiscard]] std::string cost_text(const EffectScene& scene, const EffectCost& cost);

// Of so many runs (repeats.h) the fastest, in ms of the clock.
[[nodiscard]] Result<double> fastest_ms(int runs, const std::function<Result<void>()>& run);

// A new iris's, a kept one's, a new dirt's.
[[nodiscard]] Result<std::vector<Target>> measure_starbursts(const EffectScene& scene);

// Frames with ringing beside frames without, with several lenses.
[[nodiscard]] Result<std::vector<Target>> measure_ringing(const EffectScene& scene);

// A light of many beside one alone.
[[nodiscard]] Result<std::vector<Target>> measure_many_lights(const EffectScene& scene);

// The sun beside a point, with several lenses.
[[nodiscard]] Result<std::vector<Target>> measure_area_lights(const EffectScene& scene);

}  // namespace contrejour::cli
