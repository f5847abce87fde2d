// SPDX-License-Identifier: Apache-2.0
// Starbursts for drafts. A light's own image takes longer than its ghosts, but hardly changes while the light moves: it
// is rendered once, coarsely and as far as twice the frame reaches, and drafts shift it to where the light is. The
// picture itself never contains it. Thread-safety: a plain class, one thread at a time.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "contrejour/context.h"
#include "contrejour/expert/parameter_values.h"
#include "contrejour/image.h"
#include "contrejour/lens.h"
#include "contrejour/renderer.h"

namespace contrejour::studio {

struct StarLight {
  Vec2 at;  // u, v
  std::string key;  // whatever else determines its image
  friend bool operator==(const StarLight&, const StarLight&) = default;
};

class StarLayers {
 public:
  static constexpr int kDivisor = 3;  // of the picture's width and height
  static constexpr std::size_t kMostLights = 4;

  // Whether the values ask for images of the lights at all.
  [[nodiscard]] static bool are_wanted(const params::Values& values);
  // Whether add() can stand for the images of these lights.
  [[nodiscard]] bool have(const std::vector<StarLight>& lights) const;

  // Renders what is missing, by a renderer that has the lens. Errors: those of rendering; Unsupported for pixels that
  // are not square on the sensor.
  [[nodiscard]] Result<void> prepare(const std::vector<StarLight>& lights, const params::Values& values,
                                     const LensState& lens, Renderer& renderer, const Context& context);

  // Adds them to a draft of the picture whose size is `picture` over the divisor.
  void add(const std::vector<StarLight>& lights, Vec2 picture_px, int divisor, Image& draft) const;

 private:
  struct Layer {
    std::string key;
    Image image;
    Vec2 light_px;  // in the image
  };
  [[nodiscard]] const Layer* find(const std::string& key) const;

  std::vector<Layer> layers_;  // the latest last
};

}  // namespace contrejour::studio
