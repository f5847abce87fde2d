// SPDX-License-Identifier: Apache-2.0
// Renders one frame, with a cache that may have served earlier frames: the ghosts by any method, then the lights' own
// images.
#pragma once

#include "contrejour/expert/vulkan_target.h"
#include "contrejour/method_options.h"
#include "render/planning/frame_plan.h"

namespace contrejour::inline internal {

// The result does not depend on what the cache holds. Errors: InvalidArgument, Cancelled, as render(); the cache stays
// usable.
[[nodiscard]] Result<Flare> render_frame(const MethodOptions& method, const FrameRequest& frame,
                                         const Context& context);

// Renders into a caller's image or buffer, which is of the device that the cache has (KeptDevice). What the device does
// not draw whole is uploaded to it. Errors: as those of render_frame() and of FrameDevice::write(); InvalidArgument for
// a target that the frame does not suit.
[[nodiscard]] Result<RenderStatistics> render_frame_to(const MethodOptions& method, const FrameRequest& frame,
                                                       const VulkanTarget& target, const Context& context);

// The same in layers, which the request names.
[[nodiscard]] Result<LayeredFlare> render_frame_layers(const MethodOptions& method, const FrameRequest& frame,
                                                       const Context& context);

}  // namespace contrejour::inline internal
