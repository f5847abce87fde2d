// Pictures of one frame at several resolutions, added up: pixels of level k are 2^k of the frame's along each side.
// A picture drawn at a level holds flux per pixel of that level, is convolved with a kernel there, and goes down to the
// frame's pixels by halves (halves.h), which keep its flux.
// Thread-safety: one at a time; results do not depend on the threads.
#pragma once

#include <vector>

#include "contrejour/context.h"
#include "contrejour/frame.h"
#include "contrejour/image.h"
#include "render/area/convolve.h"
#include "render/area/halves.h"
#include "render/area/kernel.h"

namespace contrejour::area {

inline constexpr int kLevels = 7;

// A frame to draw a picture in, to be convolved by a kernel that reaches so far.
struct LayerFrame {
  Frame frame;
  int level = 0;
  int left = 0, top = 0;  // its first pixel, in pixels of the level from the whole frame's corner
  // How far right and down of its place the picture is drawn, in pixels of the level, for the corner of a window of the
  // sensor is where whole numbers of pixels allow: the kernel moves it back.
  Vec2 moved;
};

class Layers {
 public:
  explicit Layers(const Frame& frame, Halving halving = Halving::Interpolating);

  // reach: of the kernel, in pixels of the level.
  [[nodiscard]] LayerFrame frame_for(int level, KernelReach reach) const;
  // unseen: what a pixel of the frame may be off by (convolve.h).
  void add(PicturePart picture, const LayerFrame& drawn, const Kernel& kernel, double unseen, const Context& context);
  // Of the frame itself.
  void add_sharp(Image picture, const Context& context);
  void add_sharp(PicturePart picture, const Context& context);
  // Nothing coarser is to come: what there is goes down. Not to be asked for; what follows then is added where there
  // are sums already, and only where it has light.
  void descend_to(int level, const Context& context);
  [[nodiscard]] Image flattened(const Context& context) &&;

 private:
  struct Layer {
    int left = 0, top = 0;  // as in LayerFrame
    int width = 0, height = 0;
    Image sum;  // without pixels while nothing was added
  };

  void add_halves(const Layer& coarse, const Layer& place, Image& fine, bool is_written, const Context& context) const;

  Frame frame_;
  Halving halving_;
  std::vector<Layer> layers_;
};

}  // namespace contrejour::area
