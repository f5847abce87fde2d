// SPDX-License-Identifier: Apache-2.0
// An image pyramid of one frame: pixels of level k are 2^k as long along each side as the frame's. A picture drawn at a
// level holds flux per pixel of that level. It is convolved with a kernel there, added to the level, and upsampled to
// the frame's pixels (halves.h), which preserves its flux.
// Thread-safety: one call at a time; results do not depend on the number of threads.
#pragma once

#include <vector>

#include "contrejour/context.h"
#include "contrejour/frame.h"
#include "contrejour/image.h"
#include "render/area_lights/convolve.h"
#include "render/area_lights/kernel.h"
#include "render/area_lights/upsampling.h"

namespace contrejour::inline internal::area {

inline constexpr int kLevels = 7;

// A frame in which to draw a picture that a kernel of a given reach is then applied to.
struct PyramidFrame {
  Frame frame;
  int level = 0;
  int left = 0, top = 0;  // its first pixel, in pixels of the level from the whole frame's corner
  // By how far to the right and down the picture is displaced, in pixels of the level, because the corner of a window
  // of the sensor must lie on a whole number of pixels: the kernel moves it back.
  Vec2 moved;
};

class ImagePyramid {
 public:
  explicit ImagePyramid(const Frame& frame, Upsampling upsampling = Upsampling::Interpolating);

  // extent: the kernel's, in pixels of the level.
  [[nodiscard]] PyramidFrame frame_for(int level, KernelExtent extent) const;
  // negligible_level: the error that a pixel of the frame may have (convolve.h).
  void add(PicturePart picture, const PyramidFrame& drawn, const Kernel& kernel, double negligible_level,
           const Context& context);
  // Add pictures at the frame's own resolution.
  void add_sharp(Image picture, const Context& context);
  void add_sharp(PicturePart picture, const Context& context);
  // Upsamples all coarser levels to this one; nothing may be added at a coarser level afterwards. Calling it is
  // optional: later pictures are then added to existing sums, and only where they have light.
  void upsample_to(int level, const Context& context);
  [[nodiscard]] Image flattened(const Context& context) &&;

 private:
  struct PyramidLevel {
    int left = 0, top = 0;  // as in PyramidFrame
    int width = 0, height = 0;
    Image sum;  // without pixels until something is added
  };

  void add_upsampled(const PyramidLevel& coarse, const PyramidLevel& target, Image& fine, bool is_written,
                     const Context& context) const;

  Frame frame_;
  Upsampling upsampling_;
  std::vector<PyramidLevel> levels_;
};

}  // namespace contrejour::inline internal::area
