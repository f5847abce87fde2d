// Which items' ringing is worth its while: fringes cost work along a ghost's whole rim, and most ghosts are so faint
// that theirs are far below the frame's error.
#pragma once

#include "render/adaptive/cells/frame_error.h"
#include "render/adaptive/item.h"
#include "render/screens/screens.h"

namespace contrejour::adaptive {

// Gives for each pass the pass whose screen it uses: where there are many, neighbours share the screen of their middle
// one, with the spread of all their wavelengths.
[[nodiscard]] std::vector<PlannedPass> screened_passes(std::span<const PlannedPass> passes);

// Gives screens, and boxes that hold the light beside the opening, to all items but those whose fringes together make
// a small part of the error. sizes: of the items (draw_roughly). Incomplete when cancelled.
[[nodiscard]] Work screen_items(const Scene& scene, Screens& screens, std::vector<Item>& items,
                                const std::vector<ItemSize>& sizes, const FrameError& allowed, const Context& context);

}  // namespace contrejour::adaptive
