// SPDX-License-Identifier: Apache-2.0
// The window: GLFW, an OpenGL 3.3 context for the interface alone, and Dear ImGui between its frames.
// Errors: Unsupported without a display or without OpenGL 3.3. Thread-safety: the main thread; wake() from any.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "contrejour/result.h"
#include "studio/ui/changed_tiles.h"
#include "studio/ui/input.h"

struct GLFWwindow;

namespace contrejour::studio {

struct WindowSettings {
  int width = 1600, height = 900;
  float scale = 1.0F;  // of fonts and distances, 0.75 to 3
  bool waits_for_display = true;  // off: frames as fast as they come, for measurements
  bool high_contrast = false;
};

class Window {
 public:
  [[nodiscard]] static Result<std::unique_ptr<Window>> open(const WindowSettings& settings);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  // Waits until something happens, for so long at most; input is then in the queue.
  void wait(double seconds);
  // Waits for the next event, for so long at most, even if there is input in the queue.
  void rest(double seconds);
  void begin_frame();
  // Shows the frame, if anything has changed since the one before. before_swap: once it is drawn, before it is on the
  // screen.
  void end_frame(const std::function<void()>& before_swap = {});
  // The next frame is drawn whole, whatever has changed.
  void redraw() { tiles_.forget(); }
  // Sets the scale of fonts and distances; it is called between two frames.
  void set_scale(float scale);
  // Showing a frame is a wait for the graphics card, and not work for the processors.
  [[nodiscard]] bool waits_in_swap() const { return !keeps_pixels_; }
  [[nodiscard]] double drawn_part() const { return drawn_part_; }  // of the window's pixels, by the last frame
  // The next frame's pixels will be read.
  void prepare_reading();
  static void wake();

  [[nodiscard]] bool wants_to_close() const;
  [[nodiscard]] bool wants_attention() const { return wants_to_close() || !dropped_.empty(); }
  void refuse_to_close();
  void set_title(const std::string& title);
  [[nodiscard]] InputQueue& input() { return input_; }
  [[nodiscard]] std::string dropped_file();  // one that the user has dropped on the window; empty: none
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

 private:
  Window(GLFWwindow* window, const WindowSettings& settings);
  void connect();
  [[nodiscard]] bool draw_changes();

  GLFWwindow* window_;
  InputQueue input_;
  ChangedTiles tiles_;
  std::string dropped_, title_;
  float scale_ = 1;
  bool high_contrast_ = false;
  bool keeps_pixels_ = false;  // a frame finds those of the frame before
  double last_frame_s_ = 0, drawn_part_ = 0;
  int width_ = 0, height_ = 0;
};

}  // namespace contrejour::studio
