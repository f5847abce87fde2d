// SPDX-License-Identifier: Apache-2.0
// Turns the lines of a script into actions of frames. Thread-safety: the thread of the interface.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "studio/ui/script.h"

namespace contrejour::studio {

struct ScriptReader {
  using Host = Script::Host;
  using Action = Script::Action;
  Script& script;

  // Errors: Parse for a command that is not known.
  Result<void> read(const nlohmann::json& line);

 private:
  void add(Action action);
  void push(InputEvent event);
  // The frame that sees an input comes before the next action.
  void frames(int count);
  void move(const std::string& id, double across, double down);
  void click(const std::string& id, double across, double down, int times);
  void drag(const std::string& id, double x, double y, int steps, double across, double down);
  // Moves a held light on a circle about the picture's middle, as often as a mouse reports: 60 times a second.
  void orbit(const std::string& id, double radius, double seconds);
  void key(const std::string& chord);
  void type(const std::string& text);
  void wait_until_idle();
  void wait_until_shown();
  void wait_seconds(double seconds);
  void save_picture(const std::string& file);
  // Random input of every kind, anywhere, for this number of frames; the same for the same seed.
  void random_input(unsigned seed, int count);
};

}  // namespace contrejour::studio
