// SPDX-License-Identifier: Apache-2.0
#include "studio/ui/input.h"

#include <set>
#include <string_view>
#include <utility>

#include <GLFW/glfw3.h>
#include <imgui.h>

namespace contrejour::studio {
namespace {

// The input that one frame has seen so far.
struct FrameInput {
  bool moved = false, pressed = false, typed = false;
  std::set<int> buttons, keys;

  // Whether the event belongs to the next frame.
  [[nodiscard]] bool is_full_for(const InputEvent& event) const {
    if (std::holds_alternative<MouseMoved>(event)) return pressed;
    if (const auto* button = std::get_if<MouseButton>(&event)) return !buttons.empty() || button->button < 0;
    if (const auto* key = std::get_if<KeyChanged>(&event)) return keys.contains(key->key) || typed;
    if (std::holds_alternative<CharacterTyped>(event)) return false;
    return false;
  }

  void see(const InputEvent& event) {
    if (std::holds_alternative<MouseMoved>(event)) moved = true;
    if (const auto* button = std::get_if<MouseButton>(&event)) {
      buttons.insert(button->button);
      pressed = true;
    }
    if (const auto* key = std::get_if<KeyChanged>(&event)) keys.insert(key->key);
    if (std::holds_alternative<CharacterTyped>(event)) typed = true;
  }
};

void apply_key(ImGuiIO& io, const KeyChanged& key) {
  if (key.key < 0 || key.key >= IM_ARRAYSIZE(io.KeysDown)) return;
  io.KeysDown[key.key] = key.is_down;
  const auto either = [&](int left, int right) { return io.KeysDown[left] || io.KeysDown[right]; };
  io.KeyCtrl = either(GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL);
  io.KeyShift = either(GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT);
  io.KeyAlt = either(GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT);
}

void apply_event(ImGuiIO& io, const InputEvent& event) {
  if (const auto* move = std::get_if<MouseMoved>(&event))
    io.MousePos = {static_cast<float>(move->x), static_cast<float>(move->y)};
  if (const auto* button = std::get_if<MouseButton>(&event))
    if (button->button >= 0 && button->button < IM_ARRAYSIZE(io.MouseDown))
      io.MouseDown[button->button] = button->is_down;
  if (const auto* wheel = std::get_if<MouseWheel>(&event)) {
    io.MouseWheelH += static_cast<float>(wheel->x);
    io.MouseWheel += static_cast<float>(wheel->y);
  }
  if (const auto* key = std::get_if<KeyChanged>(&event)) apply_key(io, *key);
  if (const auto* typed = std::get_if<CharacterTyped>(&event)) io.AddInputCharacter(typed->code);
}

constexpr std::pair<std::string_view, int> kKeyNames[] = {{"ctrl", GLFW_KEY_LEFT_CONTROL},
                                                          {"shift", GLFW_KEY_LEFT_SHIFT},
                                                          {"alt", GLFW_KEY_LEFT_ALT},
                                                          {"enter", GLFW_KEY_ENTER},
                                                          {"escape", GLFW_KEY_ESCAPE},
                                                          {"tab", GLFW_KEY_TAB},
                                                          {"space", GLFW_KEY_SPACE},
                                                          {"left", GLFW_KEY_LEFT},
                                                          {"right", GLFW_KEY_RIGHT},
                                                          {"up", GLFW_KEY_UP},
                                                          {"down", GLFW_KEY_DOWN},
                                                          {"home", GLFW_KEY_HOME},
                                                          {"end", GLFW_KEY_END},
                                                          {"delete", GLFW_KEY_DELETE},
                                                          {"backspace", GLFW_KEY_BACKSPACE},
                                                          {"[", GLFW_KEY_LEFT_BRACKET},
                                                          {"]", GLFW_KEY_RIGHT_BRACKET},
                                                          {"=", GLFW_KEY_EQUAL},
                                                          {"-", GLFW_KEY_MINUS},
                                                          {",", GLFW_KEY_COMMA},
                                                          {".", GLFW_KEY_PERIOD}};

int key_called(std::string_view name) {
  for (const auto& [known, key] : kKeyNames)
    if (known == name) return key;
  if (name.size() == 1 && name[0] >= 'a' && name[0] <= 'z') return GLFW_KEY_A + (name[0] - 'a');
  if (name.size() == 1 && name[0] >= '0' && name[0] <= '9') return GLFW_KEY_0 + (name[0] - '0');
  if (name.size() == 2 && name[0] == 'f' && name[1] >= '1' && name[1] <= '9') return GLFW_KEY_F1 + (name[1] - '1');
  if (name.size() == 3 && name.starts_with("f1") && name[2] >= '0' && name[2] <= '2')
    return GLFW_KEY_F10 + (name[2] - '0');
  return 0;
}

}  // namespace

void InputQueue::feed_frame() {
  ImGuiIO& io = ImGui::GetIO();
  FrameInput seen;
  while (!events_.empty() && !seen.is_full_for(events_.front())) {
    seen.see(events_.front());
    apply_event(io, events_.front());
    events_.pop_front();
  }
}

void set_up_keys() {
  ImGuiIO& io = ImGui::GetIO();
  constexpr std::pair<ImGuiKey_, int> keys[] = {{ImGuiKey_Tab, GLFW_KEY_TAB},
                                                {ImGuiKey_LeftArrow, GLFW_KEY_LEFT},
                                                {ImGuiKey_RightArrow, GLFW_KEY_RIGHT},
                                                {ImGuiKey_UpArrow, GLFW_KEY_UP},
                                                {ImGuiKey_DownArrow, GLFW_KEY_DOWN},
                                                {ImGuiKey_PageUp, GLFW_KEY_PAGE_UP},
                                                {ImGuiKey_PageDown, GLFW_KEY_PAGE_DOWN},
                                                {ImGuiKey_Home, GLFW_KEY_HOME},
                                                {ImGuiKey_End, GLFW_KEY_END},
                                                {ImGuiKey_Insert, GLFW_KEY_INSERT},
                                                {ImGuiKey_Delete, GLFW_KEY_DELETE},
                                                {ImGuiKey_Backspace, GLFW_KEY_BACKSPACE},
                                                {ImGuiKey_Space, GLFW_KEY_SPACE},
                                                {ImGuiKey_Enter, GLFW_KEY_ENTER},
                                                {ImGuiKey_Escape, GLFW_KEY_ESCAPE},
                                                {ImGuiKey_KeyPadEnter, GLFW_KEY_KP_ENTER},
                                                {ImGuiKey_A, GLFW_KEY_A},
                                                {ImGuiKey_C, GLFW_KEY_C},
                                                {ImGuiKey_V, GLFW_KEY_V},
                                                {ImGuiKey_X, GLFW_KEY_X},
                                                {ImGuiKey_Y, GLFW_KEY_Y},
                                                {ImGuiKey_Z, GLFW_KEY_Z}};
  for (const auto& [name, key] : keys) io.KeyMap[name] = key;
}

std::array<int, 4> keys_of_chord(const std::string& chord) {
  std::array<int, 4> keys{};
  std::size_t count = 0, from = 0;
  while (from <= chord.size() && count < keys.size()) {
    const std::size_t plus = std::min(chord.find('+', from), chord.size());
    const int key = key_called(std::string_view(chord).substr(from, plus - from));
    if (key == 0) return {};
    keys[count++] = key;
    from = plus + 1;
  }
  return keys;
}

}  // namespace contrejour::studio
