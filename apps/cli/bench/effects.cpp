// SPDX-License-Identifier: Apache-2.0
#include "cli/bench/effects.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "cli/bench/repeats.h"
#include "contrejour/expert/settings.h"
#include "contrejour/expert/trace.h"
#include "contrejour/renderer.h"

namespace contrejour::cli {
namespace {

constexpr const char* kLens = "planar-50";
constexpr double kEffectsFNumber = 8.0;
constexpr int kBlades = 7;
constexpr Vec2 kOtherLight_uv{0.70, 0.33};  // the light of other lenses, that of bodonyi2023

double processor_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Result<void> render_once(Renderer& renderer, const EffectRender& render, const Context& context) {
  if (render.layers == nullptr) {
    const auto flare = renderer.render(render.lights, render.settings, context);
    return flare ? Result<void>() : tl::unexpected(flare.error());
  }
  const auto flare = renderer.render_layers(render.lights, render.settings, *render.layers, context);
  return flare ? Result<void>() : tl::unexpected(flare.error());
}

}  // namespace

std::span<const MeasureEffect> effects() {
  static constexpr std::array kEffects{measure_starbursts, measure_ringing, measure_area_lights, measure_many_lights,
                                       measure_layers};
  return kEffects;
}

Result<EffectScene> effect_scene(const params::Values& values, int runs) {
  EffectScene scene;
  auto prescription = find_lens(kLens);
  if (!prescription) return tl::unexpected(prescription.error());
  scene.prescription = std::move(*prescription);
  scene.settings.f_number = kEffectsFNumber;
  scene.settings.iris.blades = kBlades;
  auto lens = configure_lens(scene.prescription, scene.settings);
  if (!lens) return tl::unexpected(lens.error());
  scene.lens = std::move(*lens);
  const Frame frame = params::whole_frame(values, scene.lens, *params::parse_size(*values.text("size")));
  auto lights = params::lights(values, scene.lens, frame, ColourSpace::Rec709);
  if (!lights) return tl::unexpected(lights.error());
  scene.lights = std::move(*lights);
  scene.adaptive = params::adaptive_options(values);
  scene.render = params::frame_settings(values, frame, ColourSpace::Rec709);
  scene.render.scope = GhostScope::OneSideOfStop;  // as in the papers' tables, so that figures can be compared
  scene.runs = runs;
  scene.context.threads = values.integer("threads");
  return scene;
}

Result<EffectScene> with_lens(const EffectScene& scene, const EffectSystem& system) {
  EffectScene other = scene;
  auto prescription = find_lens(system.lens);
  if (!prescription) return tl::unexpected(prescription.error());
  other.prescription = std::move(*prescription);
  other.settings = {};
  other.settings.f_number = system.f_number;
  if (system.focal_length_mm > 0.0) other.settings.focal_length_mm = system.focal_length_mm;
  auto lens = configure_lens(other.prescription, other.settings);
  if (!lens) return tl::unexpected(lens.error());
  other.lens = std::move(*lens);
  Frame& frame = other.render.frame;
  frame = frame_on_sensor(other.lens, frame.width, frame.height);
  other.lights.resize(1);
  other.lights.front().direction =
      direction_for_image_point(other.lens, frame.sensor_from_uv(kOtherLight_uv), other.lens.design_wavelength_nm);
  return other;
}

Result<EffectCost> cost_in_turns(const EffectScene& scene, const EffectRender& without, const EffectRender& with) {
  EffectCost cost{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  auto renderer = Renderer::create(scene.adaptive);
  if (!renderer) return tl::unexpected(renderer.error());
  if (const auto set = renderer->set_lens(scene.lens); !set) return tl::unexpected(set.error());
  double all_ms = 0.0;
  for (int turn = 0; another_run(turn, scene.runs, all_ms); ++turn) {
    for (const auto& [one, fastest_ms] : {std::pair(&without, &cost.without_ms), std::pair(&with, &cost.with_ms)}) {
      const double start = processor_ms();
      if (const auto done = render_once(*renderer, *one, scene.context); !done) return tl::unexpected(done.error());
      const double ms = processor_ms() - start;
      *fastest_ms = std::min(*fastest_ms, ms);
      all_ms += ms;
    }
  }
  return cost;
}

std::string cost_text(const EffectScene& scene, const EffectCost& cost) {
  return fmt::format("f/{:g}, {:.1f} ms, {:.1f} ms of processor time", scene.lens.f_number, cost.with_ms,
                     cost.without_ms);
}

Result<double> fastest_ms(int runs, const std::function<Result<void>()>& run) {
  using Clock = std::chrono::steady_clock;
  double fastest = std::numeric_limits<double>::infinity(), all_ms = 0.0;
  for (int k = 0; another_run(k, runs, all_ms); ++k) {
    const auto start = Clock::now();
    if (const auto ok = run(); !ok) return tl::unexpected(ok.error());
    const double ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    fastest = std::min(fastest, ms);
    all_ms += ms;
  }
  return fastest;
}

}  // namespace contrejour::cli
