#include "cli/bench/effects.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <limits>

#include "params/settings.h"

namespace contrejour::cli {
namespace {

constexpr const char* kLens = "planar-50";
constexpr double kFNumber = 8.0;
constexpr int kBlades = 7;

}  // namespace

std::span<const MeasureEffect> effects() {
  static constexpr std::array kEffects{measure_starbursts, measure_area_lights};
  return kEffects;
}

Result<EffectScene> effect_scene(const params::Values& values, int runs) {
  EffectScene scene;
  auto prescription = find_lens(kLens);
  if (!prescription) return tl::unexpected(prescription.error());
  scene.prescription = std::move(*prescription);
  scene.settings.f_number = kFNumber;
  scene.settings.iris.blades = kBlades;
  auto lens = lens_at(scene.prescription, scene.settings);
  if (!lens) return tl::unexpected(lens.error());
  scene.lens = std::move(*lens);
  const Frame frame = params::whole_frame(values, scene.lens, *params::parse_size(*values.text("size")));
  auto lights = params::lights(values, scene.lens, frame, ColourSpace::Rec709);
  if (!lights) return tl::unexpected(lights.error());
  scene.lights = std::move(*lights);
  scene.render = params::render_settings(values, frame, ColourSpace::Rec709);
  scene.runs = runs;
  scene.context.threads = values.integer("threads");
  return scene;
}

Result<double> fastest_ms(int runs, const std::function<Result<void>()>& run) {
  using Clock = std::chrono::steady_clock;
  double fastest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < runs; ++k) {
    const auto start = Clock::now();
    if (const auto ok = run(); !ok) return tl::unexpected(ok.error());
    fastest = std::min(fastest, std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
  return fastest;
}

}  // namespace contrejour::cli
