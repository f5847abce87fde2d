// Which items are so dim that a careless drawing of them is as good as a careful one.
#pragma once

#include "render/adaptive/cells/frame_error.h"
#include "render/adaptive/item.h"

namespace contrejour::adaptive {

// Marks those that nobody sees, even in a picture brightened by four stops, and whose light all together is a small
// part of the error that is allowed. sizes: of the items (draw_roughly); one of which nothing was seen there may be of
// any brightness and is not marked.
void mark_faint_items(std::vector<Item>& items, const std::vector<ItemSize>& sizes, const FrameError& allowed);

}  // namespace contrejour::adaptive
