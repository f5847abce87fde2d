// SPDX-License-Identifier: Apache-2.0
// Ghosts of a few pixels: bright spots on the line through the optical centre and the light, which move along it with
// the light. A spot is compared with what lies above and below it, since its neighbours lie on the line. At each
// station only that line is searched, so that a search in full resolution costs little. Thread-safety: pure functions;
// the same bits for any number of threads.
#pragma once

#include <optional>
#include <span>

#include "measure/find/find_ghosts.h"

namespace contrejour::inline internal {

inline constexpr double kLargestSpot_px = 4.7;  // the radius beyond which a ghost is sought by its edge

// The spot of the highest contrast that is not among those excluded, or none.
[[nodiscard]] std::optional<FoundGhost> strongest_spot(std::span<const SearchPicture> pictures,
                                                       const GhostSearch& search, std::span<const FoundGhost> excluded,
                                                       const Context& context);

}  // namespace contrejour::inline internal
