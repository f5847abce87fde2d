// SPDX-License-Identifier: Apache-2.0
// The test port: a file of JSON arrays, one a line, each a command that enters input as the window's own callbacks do,
// waits, or writes what the window shows (docs/studio.md lists them). Commands take as many frames as they need.
// Errors: Parse with the line; a widget that is not there ends the program with an error.
// Thread-safety: the thread of the interface.
#pragma once

#include <deque>
#include <functional>
#include <string>

#include "contrejour/result.h"
#include "studio/ui/interface.h"
#include "studio/ui/window.h"

namespace contrejour::studio {

class Script {
 public:
  [[nodiscard]] static Result<Script> read(const std::string& file);

  // Before each frame. Errors: those of the command at hand.
  [[nodiscard]] Result<void> step(Window& window, Interface& interface);
  // After each frame was drawn, before it is on the screen: for screenshots.
  [[nodiscard]] Result<void> after_frame(const Window& window);

  // How long the next frame may wait for something to happen.
  [[nodiscard]] double rest_s() const { return rest_s_; }
  [[nodiscard]] bool is_done() const { return actions_.empty() && screenshot_.empty(); }
  [[nodiscard]] bool wants_to_quit() const { return quits_; }

 private:
  struct Host {
    Window& window;
    Interface& interface;
    Script& script;
  };
  // True when it is done; else it is called in the next frame again.
  using Action = std::function<Result<bool>(Host&)>;
  friend struct ScriptReader;

  std::deque<Action> actions_;
  std::string screenshot_;
  bool quits_ = false;
  double rest_s_ = 0;
};

}  // namespace contrejour::studio
