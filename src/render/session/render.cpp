// SPDX-License-Identifier: Apache-2.0
#include "contrejour/render.h"
#include "render/session/render_frame.h"

namespace contrejour {

Result<Flare> render(const MethodOptions& method, const LensState& lens, std::span<const Light> lights,
                     const FrameSettings& settings, const Context& context) {
  RenderCache cache;
  return render_frame(method, {lens, lights, settings, cache}, context);
}

Result<Flare> render(std::string_view method, const LensState& lens, std::span<const Light> lights,
                     const FrameSettings& settings, const Context& context) {
  const auto options = method_options(method);
  if (!options) return tl::unexpected(options.error());
  return render(*options, lens, lights, settings, context);
}

}  // namespace contrejour
