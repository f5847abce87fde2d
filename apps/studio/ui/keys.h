// SPDX-License-Identifier: Apache-2.0
// Every key of the studio, in one table: the help overlay and --list-keys are made from it.
#pragma once

#include <functional>
#include <span>

#include "studio/ui/widgets.h"

namespace contrejour::studio {

struct KeyCommand {
  const char* chord;  // as keys_of_chord() reads it: "ctrl+shift+z"
  const char* shown;  // "Ctrl+Shift+Z"
  const char* group;
  const char* what;
  void (*act)(Ui& ui);
};

[[nodiscard]] std::span<const KeyCommand> all_keys();

// Does what the keys of this frame say, unless a text field or a dialog has them.
void use_keys(Ui& ui);

}  // namespace contrejour::studio
