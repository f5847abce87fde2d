#pragma once

#include "render/interface/method.h"

namespace contrejour {

// The truth in every test: double precision, dense cells with exact footprints, no shortcut that other
// renderers use.
[[nodiscard]] Result<DrawnFlare> render_reference(const PlannedFrame& planned, const ReferenceOptions& options,
                                                  const Context& context);

inline constexpr Method kReference = method_of<ReferenceOptions, render_reference>({.is_exact = true, .is_slow = true});

}  // namespace contrejour
