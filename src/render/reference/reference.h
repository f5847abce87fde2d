// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "render/planning/method.h"

namespace contrejour::inline internal {

// The reference of all tests: double precision, dense cells with exact footprints, and none of the other renderers'
// approximations.
[[nodiscard]] Result<DrawnFlare> render_reference(const PlannedFrame& planned, const ReferenceOptions& options,
                                                  const Context& context);

inline constexpr Method kReference = method_of<ReferenceOptions, render_reference>({.is_exact = true, .is_slow = true});

}  // namespace contrejour::inline internal
