// SPDX-License-Identifier: Apache-2.0
// Selects the items that get diffraction fringes. Fringes cost work along a ghost's whole rim, and in most ghosts they
// are far below the frame's error.
#pragma once

#include "render/adaptive/budget/frame_error.h"
#include "render/adaptive/item.h"
#include "render/stop_patterns/stop_transmittances.h"

namespace contrejour::inline internal::adaptive {

// Returns, for each pass, the pass whose stop pattern it uses. If there are many, neighbours share the pattern of their
// middle one, averaged over all their wavelengths.
[[nodiscard]] std::vector<PlannedPass> passes_with_patterns(std::span<const PlannedPass> passes);

// Gives stop patterns, and boxes wide enough for the light outside the opening, to all items except those whose fringes
// together make a small part of the error. estimates: the items' in the preview frame (draw_preview). Incomplete when
// cancelled.
[[nodiscard]] Work set_stop_patterns(const Scene& scene, StopTransmittances& stops, std::vector<Item>& items,
                                     const std::vector<ItemEstimate>& estimates, const FrameError& allowed,
                                     const Context& context);

}  // namespace contrejour::inline internal::adaptive
