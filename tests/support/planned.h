// SPDX-License-Identifier: Apache-2.0
// Runs one renderer by itself, without those in the registry.
#pragma once

#include <span>

#include "render/planning/method.h"

namespace contrejour::test {

template <OptionsOfMethod Options>
Result<Flare> render_alone(DrawWithOptions<Options> draw, const Options& options, const LensState& lens,
                           std::span<const Light> lights, const FrameSettings& settings, const Context& context = {}) {
  RenderCache cache;
  auto ghosts = render_planned(
      [&](const PlannedFrame& planned, const Context& drawing) { return draw(planned, options, drawing); },
      {lens, lights, settings, cache}, context);
  if (!ghosts) return tl::unexpected(ghosts.error());
  return Flare{std::move(ghosts->image), std::move(ghosts->statistics)};
}

}  // namespace contrejour::test
