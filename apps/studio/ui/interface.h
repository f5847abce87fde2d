// SPDX-License-Identifier: Apache-2.0
// The whole interface: where the panels are, and one frame of all of them.
#pragma once

#include <string>

#include "studio/core/studio.h"
#include "studio/ui/pace.h"
#include "studio/ui/texture.h"
#include "studio/ui/widgets.h"

namespace contrejour::studio {

class Interface {
 public:
  Interface(Studio& studio, double scale);

  void draw_frame();
  // Something of the last frame asks for another one at once.
  [[nodiscard]] bool needs_frame() const;
  void open_file(const std::string& file);  // a lens, a session or a plate
  void ask_to_quit();
  [[nodiscard]] double scale() const { return scale_of(studio_.view, state_); }
  [[nodiscard]] bool wants_to_quit() const { return state_.wants_to_quit; }

  // Everything that a test or an assistive program may ask, as JSON.
  [[nodiscard]] std::string state_json() const;
  [[nodiscard]] const WidgetRegistry& widgets() const { return registry_; }
  [[nodiscard]] Pace& pace() { return pace_; }
  [[nodiscard]] Studio& studio() { return studio_; }
  // The studio's count of pictures when the last frame was drawn.
  [[nodiscard]] std::uint64_t pictures_drawn() const { return shown_count_; }
  [[nodiscard]] std::uint64_t frames() const { return frames_; }

 private:
  void draw_panels();
  void draw_side(float width, float height);
  void draw_bottom(float width, float height);
  void take_picture();

  Studio& studio_;
  InterfaceState state_;
  WidgetRegistry registry_;
  Pace pace_;
  Texture picture_;
  TextureSet textures_;
  std::uint64_t frames_ = 0, shown_count_ = 0;
};

}  // namespace contrejour::studio
