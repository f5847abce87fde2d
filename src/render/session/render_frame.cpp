// SPDX-License-Identifier: Apache-2.0
#include "render/session/render_frame.h"

#include <algorithm>

#include "base/memory.h"
#include "base/tasks.h"
#include "contrejour/expert/check_lens.h"
#include "render/area_lights/area_render.h"
#include "render/session/registry.h"
#include "render/starburst/starburst_pass.h"

namespace contrejour::inline internal {
namespace {

constexpr double kGhostsFraction = 0.9;  // of the progress; the rest is for the lights' own images

// A context that maps its progress to the part of the whole from one fraction to another.
Context part_of(const Context& whole, double from, double to) {
  Context part = whole;
  if (whole.progress) part.progress = [&whole, from, to](double done) { whole.progress(from + (to - from) * done); };
  return part;
}

Result<Flare> render_ghosts(const DrawPlan& draw, const FrameRequest& frame, const Context& context) {
  const bool points = std::ranges::all_of(frame.lights, [](const Light& light) { return light.is_point(); });
  return (points ? render_planned : render_areas)(draw, frame, context);
}

Result<Flare> render_with_lights(const DrawPlan& draw, const FrameRequest& frame, const Context& context) {
  const auto& [lens, lights, settings, cache] = frame;
  if (const auto good = check_light_images(lights, settings); !good) return tl::unexpected(good.error());
  auto flare = render_ghosts(draw, frame, part_of(context, 0.0, kGhostsFraction));
  if (!flare) return flare;
  const auto added = add_light_images(*flare, lens, settings.starburst.lights ? *settings.starburst.lights : lights,
                                      settings, part_of(context, kGhostsFraction, 1.0));
  if (!added) return tl::unexpected(added.error());
  return flare;
}

}  // namespace

Result<Flare> render_frame(const MethodOptions& method, const FrameRequest& frame, const Context& context) {
  if (auto good = check_lens(frame.lens); !good) return tl::unexpected(good.error());
  const auto known = known_method(method.name());
  if (!known) return tl::unexpected(known.error());
  const DrawPlan draw = [&](const PlannedFrame& planned, const Context& drawing) {
    return (*known)->draw(planned, method, drawing);
  };
  const bool adds_lights = frame.settings.starburst.on || frame.settings.glare.fraction != 0.0;
  auto flare = (adds_lights ? render_with_lights : render_ghosts)(draw, frame, context);
  if (context.cancelled()) return interrupted();  // some of its loops may have stopped early
  if (flare) flare->statistics.peak_memory_bytes = peak_memory_bytes();
  return flare;
}

}  // namespace contrejour::inline internal
