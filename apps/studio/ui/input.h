// SPDX-License-Identifier: Apache-2.0
// Input of the window in the order in which it happened. Dear ImGui 1.86 looks at the state of mouse and keys once a
// frame, so a click or a key that is shorter than a frame would be lost, and a press is seen where the mouse is by the
// time of the frame. This queue gives each frame only as much as one frame can see: changes of a button or a key up
// to the second one of the same, and a press only where the mouse was. Scripts of tests enter here, too.
// Thread-safety: the thread of the interface.
#pragma once

#include <array>
#include <deque>
#include <string>
#include <variant>

namespace contrejour::studio {

struct MouseMoved {
  double x = 0, y = 0;  // from the window's top left corner
};
struct MouseButton {
  int button = 0;
  bool is_down = false;
};
struct MouseWheel {
  double x = 0, y = 0;
};
struct KeyChanged {
  int key = 0;  // GLFW_KEY_...
  bool is_down = false;
};
struct CharacterTyped {
  unsigned int code = 0;
};
using InputEvent = std::variant<MouseMoved, MouseButton, MouseWheel, KeyChanged, CharacterTyped>;

class InputQueue {
 public:
  void push(InputEvent event) { events_.push_back(event); }
  // Hands as many events to Dear ImGui as this frame can see.
  void feed_frame();
  [[nodiscard]] bool is_empty() const { return events_.empty(); }

 private:
  std::deque<InputEvent> events_;
};

// Connects the mouse and key names of Dear ImGui with GLFW's numbers; once, after its context was made.
void set_up_keys();

// "ctrl+shift+z", "f1", "tab": the keys in the order in which they are pressed; empty for an unknown name.
[[nodiscard]] std::array<int, 4> keys_of_chord(const std::string& chord);

}  // namespace contrejour::studio
