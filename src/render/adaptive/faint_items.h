// SPDX-License-Identifier: Apache-2.0
// Which items are so dim that preview quality is as good as full quality.
#pragma once

#include "render/adaptive/cells/frame_error.h"
#include "render/adaptive/item.h"

namespace contrejour::inline internal::adaptive {

// Marks items that stay invisible even in a picture brightened by four stops, and whose light all together is a small
// part of the allowed error. sizes: the items' levels and areas in the preview frame (draw_roughly). An item of which
// the preview shows nothing may have any brightness and is not marked.
void mark_faint_items(std::vector<Item>& items, const std::vector<ItemSize>& sizes, const FrameError& allowed);

}  // namespace contrejour::inline internal::adaptive
