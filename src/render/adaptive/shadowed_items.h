// SPDX-License-Identifier: Apache-2.0
// Selects the items whose shadows of dirt are drawn. Each costs the outlines of all shapes that the ghost's light
// crosses. The other items are dimmed by dirt's mean transmittance.
#pragma once

#include "render/adaptive/budget/frame_error.h"
#include "render/adaptive/item.h"
#include "render/stop_patterns/stop_transmittances.h"

namespace contrejour::inline internal::adaptive {

// Sets the mean transmittance of dirt for each item. The scene's lens has dirt.
void dim_items(const Scene& scene, std::vector<Item>& items);

// Gives shadows to all items except those in which leaving them out makes, all together, a small part of the error.
// estimates: the items' in the preview frame (draw_preview). Incomplete when cancelled.
void shadow_items(const Scene& scene, StopTransmittances& stops, std::vector<Item>& items,
                  const std::vector<ItemEstimate>& estimates, const FrameError& allowed, const Context& context);

}  // namespace contrejour::inline internal::adaptive
