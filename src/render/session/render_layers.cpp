// SPDX-License-Identifier: Apache-2.0
#include "contrejour/expert/flare_layers.h"

#include <algorithm>

#include "contrejour/expert/check_lens.h"
#include "render/planning/ghost_selection.h"
#include "render/session/render_frame.h"

namespace contrejour {

Result<LayeredFlare> render_layers(const MethodOptions& method, const LensState& lens, std::span<const Light> lights,
                                   const FrameSettings& settings, const LayerOptions& options, const Context& context) {
  RenderCache cache;
  return render_frame_layers(method, {lens, lights, settings, cache, &options}, context);
}

Result<std::vector<Ghost>> brightest_ghosts(const LensState& lens, std::span<const Light> lights,
                                            const FrameSettings& settings, const LayerOptions& options,
                                            const Context& context) {
  if (auto good = check_lens(lens); !good) return tl::unexpected(good.error());
  LayerOptions by_ghost = options;
  by_ghost.by = LayersBy::Ghost;
  std::vector<Light> points(lights.begin(), lights.end());  // areas are ranked by the light of their middle
  for (Light& light : points) light.radius_rad = 0.0, light.shape = nullptr;
  RenderCache cache;
  const auto plan = plan_frame({lens, points, settings, cache, &by_ghost}, context);
  if (!plan) return tl::unexpected(plan.error());
  return plan->layers->ghosts();
}

Image whole_image(const FlareLayer& layer, int width, int height) {
  Image whole(width, height);
  for (int y = 0; y < layer.image.height; ++y)
    std::ranges::copy(layer.image.row(y), &whole.at(layer.left, layer.top + y));
  return whole;
}

}  // namespace contrejour
