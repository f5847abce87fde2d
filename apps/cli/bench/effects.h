// SPDX-License-Identifier: Apache-2.0
// Rows of `bench effects`: the costs of starbursts, dirt, ringing and extended lights, each with its target. A new row
// is a function here and a line in effects.cpp.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/bench/target.h"
#include "contrejour/expert/flare_layers.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/lens.h"
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

// The lens and the light that all rows have in common, on a frame of `values`' size: planar-50 at f/8, 7 blades.
[[nodiscard]] Result<EffectScene> effect_scene(const params::Values& values, int runs);

using MeasureEffect = Result<std::vector<Target>> (*)(const EffectScene& scene);
[[nodiscard]] std::span<const MeasureEffect> effects();

// Another lens with the scene's light and picture size.
struct EffectSystem {
  const char* lens;
  double focal_length_mm;  // 0: no zoom
  double f_number;
};
[[nodiscard]] Result<EffectScene> with_lens(const EffectScene& scene, const EffectSystem& system);

// One renderer renders with an effect and without it, alternately, so that changes of the machine's speed affect both;
// it keeps between frames what it would keep in a sequence. The result is the fastest of the scene's runs (repeats.h),
// in processor time of all threads together, which does not include that of other programs.
struct EffectRender {
  FrameSettings settings;
  std::vector<Light> lights;
  const LayerOptions* layers = nullptr;  // null: one picture
};
struct EffectCost {
  double without_ms = 0.0, with_ms = 0.0;
  [[nodiscard]] double ratio() const { return with_ms / without_ms; }
};
[[nodiscard]] Result<EffectCost> cost_in_turns(const EffectScene& scene, const EffectRender& without,
                                               const EffectRender& with);

// "f/8, 40.1 ms, 30.0 ms of processor time".
[[nodiscard]] std::string cost_text(const EffectScene& scene, const EffectCost& cost);

// The time of the fastest of at least `runs` runs (repeats.h), in ms of elapsed time.
[[nodiscard]] Result<double> fastest_ms(int runs, const std::function<Result<void>()>& run);

// The costs of a new iris, of a kept starburst and of new dirt.
[[nodiscard]] Result<std::vector<Target>> measure_starbursts(const EffectScene& scene);

// Frames with ringing compared with frames without, with several lenses.
[[nodiscard]] Result<std::vector<Target>> measure_ringing(const EffectScene& scene);

// A light among many compared with a single light.
[[nodiscard]] Result<std::vector<Target>> measure_many_lights(const EffectScene& scene);

// A frame in layers compared with one picture, with several lenses.
[[nodiscard]] Result<std::vector<Target>> measure_layers(const EffectScene& scene);

// The sun compared with a point, with several lenses.
[[nodiscard]] Result<std::vector<Target>> measure_area_lights(const EffectScene& scene);

}  // namespace contrejour::cli
