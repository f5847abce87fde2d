// SPDX-License-Identifier: Apache-2.0
// A few elements of SVG, written as text. Coordinates are in pixels, y downwards.
#pragma once

#include <string>
#include <vector>

#include "contrejour/expert/vec.h"

namespace contrejour::cli {

class Svg {
 public:
  Svg(double width, double height);

  // style: presentation attributes as written, e.g. `stroke="#000"`.
  void rectangle(Vec2 corner, Vec2 size, const std::string& style);
  void line(Vec2 from, Vec2 to, const std::string& style);
  void polyline(const std::vector<Vec2>& points, const std::string& style);
  void path(const std::string& data, const std::string& style);
  void circle(Vec2 centre, double radius, const std::string& style);
  void text(Vec2 position, const std::string& words, const std::string& style);

  void begin_clip(Vec2 corner, Vec2 size);  // until end_clip, nothing outside is drawn
  void end_clip();

  [[nodiscard]] std::string finish() const;

 private:
  std::string body_;
  double width_, height_;
  int clips_ = 0;
};

}  // namespace contrejour::cli
