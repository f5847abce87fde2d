// SPDX-License-Identifier: Apache-2.0
// The error that each item of a frame may make.
#pragma once

#include <vector>

#include "render/adaptive/budget/frame_error.h"
#include "render/adaptive/budget/tolerance.h"
#include "render/planning/frame_plan.h"

namespace contrejour::inline internal::adaptive {

// An item's size in the preview frame.
struct ItemEstimate : LevelEstimate {
  double rays = 0;  // traced for it in the preview frame
};

// The error that one item may make, where all make the allowed one together.
[[nodiscard]] ErrorBudget budget_per_item(const FrameError& allowed, const std::vector<ItemEstimate>& estimates);

// The same for this item. has_fringes: it is drawn behind stop patterns. is_negligible: preview quality is enough for
// it.
[[nodiscard]] ErrorBudget budget_of(const ItemEstimate& estimate, bool has_fringes, bool is_negligible,
                                    const ErrorBudget& per_item);

// Returns, by item, whether preview quality is as good as full quality: the item stays invisible even in a picture
// brightened by four stops, and the light of all such items together is a small part of the allowed error. estimates:
// the items' levels and areas in the preview frame (draw_preview). An item of which the preview shows nothing may have
// any brightness and is not among them.
[[nodiscard]] std::vector<bool> negligible_items(const std::vector<ItemEstimate>& estimates, const FrameError& allowed);

// The peak that errors are relative to where the preview frame is dark. It is far below the level of any ghost, so that
// a ghost's errors count relative to its own level.
[[nodiscard]] double faintest_peak(const FramePlan& plan, const Frame& frame);

}  // namespace contrejour::inline internal::adaptive
