// SPDX-License-Identifier: Apache-2.0
// A parameter of the one table as a row: its name, its value in the widget of its kind, its key, its way back to the
// default. Every panel that shows a parameter draws it so.
#pragma once

#include "studio/ui/widgets.h"

namespace contrejour::studio {

// The name as a label, with the unit of a number: "blade rotation  deg" of --blade-rotation.
[[nodiscard]] std::string label_of(const params::Parameter& parameter);

// label_width: at scale 1.
void draw_parameter(Ui& ui, const params::Parameter& parameter, float label_width = 162);

// A small diamond that sets a key at the frame, or removes the one that is there; full where there is one.
void key_button(Ui& ui, const std::string& id, const TrackId& track);

}  // namespace contrejour::studio
