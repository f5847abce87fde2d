// SPDX-License-Identifier: Apache-2.0
// Renders one frame, with a cache that may have served earlier frames: the ghosts by any method, then the lights' own
// images.
#pragma once

#include "contrejour/method_options.h"
#include "render/planning/frame_plan.h"

namespace contrejour::inline internal {

// The result does not depend on what the cache holds. Errors: InvalidArgument, Cancelled, as render(); the cache stays
// usable.
[[nodiscard]] Result<Flare> render_frame(const MethodOptions& method, const FrameRequest& frame,
                                         const Context& context);

// The same in layers, which the request names.
[[nodiscard]] Result<LayeredFlare> render_frame_layers(const MethodOptions& method, const FrameRequest& frame,
                                                       const Context& context);

}  // namespace contrejour::inline internal
