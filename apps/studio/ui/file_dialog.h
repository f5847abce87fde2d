// SPDX-License-Identifier: Apache-2.0
// Parts of dialogs.
#pragma once

#include <functional>

#include "studio/ui/widgets.h"

namespace contrejour::studio {

// The path, then a folder's files, then the button that does it; Enter does it, too. act: true closes the dialog.
void draw_file_dialog(Ui& ui, const char* action, const std::function<bool()>& act);

void draw_export_dialog(Ui& ui);

}  // namespace contrejour::studio
