// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/planning/method.h"
#include "render/pupils/ray_source.h"

namespace contrejour::inline internal {

// The adaptive renderer, this project's own method: each ghost is a smooth map fitted to a few exact rays, drawn with
// no more cells than its part of the allowed error requires (docs/physics/adaptive.md).
[[nodiscard]] Result<DrawnFlare> render_adaptive(const PlannedFrame& planned, const AdaptiveOptions& options,
                                                 const Context& context);

// The same at an error, with the rays of a fit; null: all are traced.
[[nodiscard]] Result<DrawnFlare> draw_adaptive(const PlannedFrame& planned, double error,
                                               const pupils::FittedGhosts* fitted, const Context& context);

inline constexpr Method kAdaptive = method_of<AdaptiveOptions, render_adaptive>({.spends_error = true});

}  // namespace contrejour::inline internal
