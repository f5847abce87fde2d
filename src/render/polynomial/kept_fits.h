// SPDX-License-Identifier: Apache-2.0
// The fit that a frame is drawn with: the caller's, a file's, or one made for the frame's ghosts. It is kept from frame
// to frame, in sections of RenderCache.
#pragma once

#include <memory>

#include "contrejour/expert/polynomial_method.h"
#include "polynomial/fitted_lens.h"
#include "render/planning/frame_plan.h"

namespace contrejour::inline internal {

// Errors: Cancelled, those of reading a file; InvalidArgument for a fit of another lens.
[[nodiscard]] Result<std::shared_ptr<const polynomial::FittedLens>> fitted_lens(const PlannedFrame& planned,
                                                                                const PolynomialRenderOptions& options,
                                                                                const Context& context);

}  // namespace contrejour::inline internal
