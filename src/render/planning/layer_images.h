// SPDX-License-Identifier: Apache-2.0
// The images that a method without cropping draws into: one a layer of the plan, or the picture.
// Thread-safety: one thread at a time.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "render/planning/frame_plan.h"

namespace contrejour::inline internal {

class LayerImages {
 public:
  LayerImages(const FramePlan& plan, const Frame& frame)
      : frame_(frame), has_layers_(plan.layers != nullptr), images_(has_layers_ ? plan.layers->count() : 1) {}

  // The image of a layer, which is made when it gets its first light. Without layers: of the picture, 0.
  [[nodiscard]] Image& at(std::size_t layer) {
    Image& image = images_[layer].image;
    if (image.pixels.empty()) image = Image(frame_.width, frame_.height);
    return image;
  }
  void set(std::size_t layer, Image image) { images_[layer].image = std::move(image); }

  void move_to(DrawnFlare& flare) {
    if (has_layers_) {
      flare.layers = std::move(images_);
    } else {
      static_cast<void>(at(0));
      flare.picture = std::move(images_.front());
    }
  }

 private:
  const Frame& frame_;
  bool has_layers_;
  std::vector<DrawnImage> images_;
};

}  // namespace contrejour::inline internal
