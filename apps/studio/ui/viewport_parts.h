// SPDX-License-Identifier: Apache-2.0
// Parts of the viewport: the handles of lights, and what is drawn over the picture.
#pragma once

#include "studio/ui/viewport_map.h"
#include "studio/ui/widgets.h"

namespace contrejour::studio {

// Draws the handles. A light outside the viewport has its handle at the edge, with an arrow.
void draw_light_handles(Ui& ui, const ViewportMap& map);
// Drags, adds and selects lights with the mouse; true if a handle has the mouse.
bool use_light_handles(Ui& ui, const ViewportMap& map, bool is_hovered);

// The edge of a wipe: drags it with the mouse; true if it has the mouse.
bool use_wipe_edge(Ui& ui, const ViewportMap& map, bool is_hovered);

void draw_frame_guides(const ViewportMap& map);
void draw_selected_ghost(Ui& ui, const ViewportMap& map);
// Whether the picture is a draft; unless it is to be short, its size and how long it took.
void draw_picture_badge(Ui& ui, bool is_short);

// The menu of view transforms.
void draw_view_choice(Ui& ui, float width);

}  // namespace contrejour::studio
