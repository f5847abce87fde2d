#include "contrejour/frame.h"

#include <algorithm>

namespace contrejour {

Frame frame_on_sensor(const LensState& lens, int width, int height) {
  Frame frame;
  frame.width = frame.full_width = width;
  frame.height = frame.full_height = height;
  frame.pixel_pitch_mm = std::min(lens.sensor_width_mm / width, lens.sensor_height_mm / height);
  return frame;
}

}  // namespace contrejour
