// Which items' shadows of dirt are worth their while: each costs the outlines of all that lies in the ghost's way. The
// others are dimmed by what dirt takes of them in the mean.
#pragma once

#include "render/adaptive/cells/frame_error.h"
#include "render/adaptive/item.h"
#include "render/screens/screens.h"

namespace contrejour::adaptive {

// Sets what dirt leaves of each item's light. The scene's lens has dirt.
void dim_items(const Scene& scene, std::vector<Item>& items);

// Gives shadows to all items but those in which leaving them out makes a small part of the error, all together. sizes:
// of the items (draw_roughly). Incomplete when cancelled.
void shadow_items(const Scene& scene, Screens& screens, std::vector<Item>& items, const std::vector<ItemSize>& sizes,
                  const FrameError& allowed, const Context& context);

}  // namespace contrejour::adaptive
