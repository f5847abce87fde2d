// SPDX-License-Identifier: Apache-2.0
// The order in which ghosts are listed. Thread-safety: pure.
#pragma once

#include <array>
#include <vector>

#include "contrejour/ghost_figures.h"

namespace contrejour::studio {

enum class GhostOrder { Visibility, Flux, Peak };
inline constexpr std::array<GhostOrder, 3> kGhostOrders = {GhostOrder::Visibility, GhostOrder::Flux, GhostOrder::Peak};
[[nodiscard]] const char* name_of(GhostOrder order);

// How much a ghost is noticed, in arbitrary units: its mean irradiance times its diameter, with which the contrast
// that is just seen falls (A. Rose, The sensitivity performance of the human eye on an absolute scale, 1948), for the
// part of it inside the frame. A veil over the whole frame has much flux and a spot a high peak, but neither need be
// what one sees first.
[[nodiscard]] double visibility(const GhostFigures& ghost, Vec2 frame_px);

// The part of the box around a ghost that lies inside the frame, 0 to 1.
[[nodiscard]] double part_in_frame(const GhostFigures& ghost, Vec2 frame_px);

// Indices into the figures.
[[nodiscard]] std::vector<std::size_t> ghosts_in_order(const std::vector<GhostFigures>& figures, GhostOrder order,
                                                       Vec2 frame_px);

}  // namespace contrejour::studio
