// SPDX-License-Identifier: Apache-2.0
// Each panel fills the child window that it is called in.
#pragma once

#include "studio/ui/texture.h"
#include "studio/ui/widgets.h"

namespace contrejour::studio {

void draw_toolbar(Ui& ui);
void draw_status_bar(Ui& ui);
void draw_viewport(Ui& ui, Texture& picture);
void draw_section_panel(Ui& ui);
void draw_prescription_panel(Ui& ui);
void draw_coatings_panel(Ui& ui);
void draw_ghosts_panel(Ui& ui);
void draw_lights_panel(Ui& ui);
void draw_parameters_panel(Ui& ui);
void draw_looks_panel(Ui& ui, TextureSet& textures);
void draw_history_panel(Ui& ui);
void draw_iris_panel(Ui& ui, TextureSet& textures);
void draw_timeline_panel(Ui& ui);
void draw_compare_panel(Ui& ui, TextureSet& textures);
void draw_measured_panel(Ui& ui, TextureSet& textures);
void draw_dialogs(Ui& ui);
void draw_help_overlay(Ui& ui);

}  // namespace contrejour::studio
