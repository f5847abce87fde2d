// SPDX-License-Identifier: Apache-2.0
// The cost of ringing: of computing its diffraction patterns, and of frames with fringes relative to frames without.
#include <utility>

#include <fmt/format.h>

#include "cli/bench/effects.h"

namespace contrejour::cli {
namespace {

constexpr double kFrame = 1.3, kPatterns_ms = 2000.0;

// In addition to the scene's own lens. The long zoom has the most ghosts, 312; at f/32 half of them have patterns.
constexpr EffectSystem kRingingSystems[] = {{"heliar", 0.0, 16.0},
                                            {"itoh-zoom", 123.0, 32.0},
                                            {"nikon-80-200", 140.0, 16.0},
                                            {"canon-70-200", 135.0, 8.0},
                                            {"canon-70-200", 135.0, 32.0}};

// The time of a frame with ringing, including the computation of its patterns, and its ratio to that of a frame
// without.
Result<std::vector<Target>> rows_of(const EffectScene& scene) {
  const Light& light = scene.lights.front();
  FrameSettings ringing = scene.render;
  ringing.ringing.mode = RingingMode::Fresnel;
  const auto new_ms = fastest_ms(1, [&]() -> Result<void> {
    const auto flare = render(scene.adaptive, scene.lens, {&light, 1}, ringing, scene.context);
    if (!flare) return tl::unexpected(flare.error());
    return {};
  });
  if (!new_ms) return tl::unexpected(new_ms.error());
  const auto cost = cost_in_turns(scene, {scene.render, {light}}, {ringing, {light}});
  if (!cost) return tl::unexpected(cost.error());
  return std::vector<Target>{Target{.name = "frame, rims ringing / sharp",
                                    .system = scene.lens.name,
                                    .value = cost->ratio(),
                                    .must = kFrame,
                                    .aim = kFrame,
                                    .note = cost_text(scene, *cost)},
                             Target{.name = "first frame, ringing of a new iris",
                                    .system = scene.lens.name,
                                    .value = *new_ms,
                                    .must = kPatterns_ms,
                                    .aim = kPatterns_ms,
                                    .unit = "ms",
                                    .note = fmt::format("f/{:g}", scene.lens.f_number)}};
}

}  // namespace

Result<std::vector<Target>> measure_ringing(const EffectScene& scene) {
  auto rows = rows_of(scene);
  for (const EffectSystem& system : kRingingSystems) {
    if (!rows) return rows;
    const auto other = with_lens(scene, system);
    if (!other) return tl::unexpected(other.error());
    const auto more = rows_of(*other);
    if (!more) return tl::unexpected(more.error());
    rows->insert(rows->end(), more->begin(), more->end());
  }
  return rows;
}

}  // namespace contrejour::cli
