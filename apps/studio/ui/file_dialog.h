// SPDX-License-Identifier: Apache-2.0
// Parts of dialogs.
#pragma once

#include <functional>

#include "studio/ui/widgets.h"

namespace contrejour::studio {

// The path, then a folder's files, then the button that does it; Enter does it, too. act: true closes the dialog.
// replaces: whether it would replace a file, for which the dialog asks first.
void draw_file_dialog(Ui& ui, const char* action, const std::function<bool()>& act,
                      const std::function<bool()>& replaces = {});

void draw_export_dialog(Ui& ui);

// True: Enter was pressed.
[[nodiscard]] bool draw_path_field(Ui& ui);
// The files of the dialog's kind in the folder of the path.
void draw_folder(Ui& ui);
// The path is a folder, which the dialog now lists, rather than a file for it.
[[nodiscard]] bool lists_folder_typed(Ui& ui);
// The dialog opens in this path's folder the next time.
void remember_folder(Ui& ui, Dialog dialog);

}  // namespace contrejour::studio
